// The log lines of clearance-merge; log_lines.hpp has those of the daemon, and the rules for both.
#pragma once

#include "monitor/interface/log_lines.hpp"

namespace clearance::lines {

inline constexpr LogLine<Text, Count, Text> kMergeStarted{"merge-started", kInfo,
                                                          "cell '{}' in {} shares on {}"};
inline constexpr LogLine<Text, Count> kShareHeard{"share-heard", kInfo,
                                                  "the share '{}' (revision {:016x}) is heard"};
inline constexpr LogLine<Text> kShareMissing{
    "share-missing", kError,
    "the share '{}' is missing: its pairs are unknown, and its zones active"};
inline constexpr LogLine<Text, double> kShareLate{
    "share-late", kWarn,
    "the last report of the share '{}' is {:.0f} ms old: its pairs are unknown, and its zones "
    "active"};
inline constexpr LogLine<Count, Text> kCellNotRead{
    "cell-not-read", kError,
    "ROS 2 gets no markers, numbers and diagnostics: the shares have changed to revision {:016x} "
    "of the cell, which cannot be read here: {}"};
inline constexpr LogLine<Text, Count, Count> kShareOtherRevision{
    "share-other-revision", kError,
    "the share '{}' has revision {:016x} of the cell and most others have {:016x}: its pairs are "
    "unknown, and its zones active"};

inline constexpr LogLine<Text> kShareOtherDivision{
    "share-other-division", kError,
    "the share '{}' divides the cell otherwise than the others, so that a pair may be in no share: "
    "its pairs are unknown, and its zones active"};

inline constexpr LogLine<Text> kShareHeld{
    "share-held", kError,
    "two messages of the share '{}' were faulty within an hour: its pairs are unknown, and its "
    "zones active, until this program is started again"};

}  // namespace clearance::lines
