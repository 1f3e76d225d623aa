#include "tools/view/channels.hpp"

#include "monitor/recording/topic_schema.hpp"
#include "monitor/visual/cell_markers.hpp"
#include "monitor/visual/ros_types.hpp"
#include "monitor/visual/seen_points.hpp"

namespace clearance::view {

std::vector<Channel> channels_of(const Topics& topics) {
  std::vector<Channel> channels;
  for (const Topic& topic : kRecordedTopics) {
    // The whole text: viewers hold one definition of each module, also of its constants, for all
    // channels. The cut texts of recordings have other constants for each topic.
    const McapSchema& cut = topic_schema(topic.kind);
    channels.push_back({topics.*topic.name, {cut.name, cut.encoding, kIdlText}});
  }
  channels.push_back({kTransformsTopic, ros::transforms_schema()});
  channels.push_back({kBodiesTopic, ros::markers_schema()});
  channels.push_back({kClosestTopic, ros::markers_schema()});
  channels.push_back({kSeenTopic, seen_points_schema()});
  return channels;
}

}  // namespace clearance::view
