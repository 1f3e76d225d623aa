// The daemon's log lines: the only place where their wording stands.
// tests/monitor/app/messages.golden shows each of them with sample arguments.
//
// A new line is one entry here and its name in all_log_lines.hpp. Codes do not change: they are
// what tests, FAULTS.md and other programs look for. An argument "2 joints" comes from counted().
#pragma once

#include "monitor/interface/log_line.hpp"

namespace clearance::lines {

using Text = std::string_view;
using Count = std::uint64_t;
using enum LogLevel;

// ---- Start and end of the daemon

inline constexpr LogLine<Text, Count, double, Text> kStarted{
    "started", kInfo, "cell '{}' (revision {:016x}) at {} Hz on {}"};
inline constexpr LogLine<Count, Count> kSelfTest{
    "self-test", kInfo, "ticks check {} kB of constant memory, all of it within {} ticks"};
inline constexpr LogLine<Text, Count> kSelfTestFailed{
    "self-test-failed", kError,
    "{}, found in tick {}, whose report is not published. The daemon ends: start it again. If this "
    "comes again, have the memory of this machine tested"};
inline constexpr LogLine<Text> kHowToReach{"how-to-reach", kInfo, "{}"};
inline constexpr LogLine<Text> kSystemRefuses{"system-refuses", kWarn, "{}"};
inline constexpr LogLine<Text> kPartitionWithoutRos{
    "partition-without-ros", kWarn,
    "ROS 2 uses the default partition only: in {}, no tf comes, and no node gets what is written"};
inline constexpr LogLine<Text> kNoSpeedScaling{
    "no-speed-scaling", kWarn,
    "{} is not published: the cell has no zone; one with 'separation:' scales from 0 to 1"};
inline constexpr LogLine<Text> kStopped{"stopped", kInfo, "stopped after {}"};
inline constexpr LogLine<Text, Text> kReading{"cell-read-again", kInfo,
                                              "{}: {} is read again; SIGTERM ends the daemon"};
inline constexpr LogLine<Count, Count, Count> kSceneChanged{
    "scene-changed", kInfo,
    "the cell's revision {:016x} is in force from cycle {}, and {:016x} is not any more"};
inline constexpr LogLine<> kSceneUnchanged{
    "scene-unchanged", kInfo, "the cell has the revision that is in force: nothing changes"};
inline constexpr LogLine<Text> kSceneRefused{
    "scene-refused", kWarn, "the changed cell is not used, and the one before stays in force: {}"};
inline constexpr LogLine<Text, Count, Text, Text> kCommandRefused{
    "command-refused", kWarn, "request {1} of '{0}' is refused ({2}): {3}"};
inline constexpr LogLine<Text> kCommandsLeftOut{"commands-left-out", kWarn,
                                                "{} about refused commands left out"};
inline constexpr LogLine<Text, Count, Text> kNoted{"noted", kInfo, "'{}' notes in request {}: {}"};
inline constexpr LogLine<Text, Count, Text, Text> kQuestionRefused{
    "question-refused", kWarn, "question {1} of '{0}' is refused ({2}): {3}"};
inline constexpr LogLine<Text> kQuestionsLeftOut{"questions-left-out", kWarn,
                                                 "{} about refused questions left out"};
inline constexpr LogLine<Text> kMoveItSilent{"moveit-silent", kWarn, "no MoveIt is heard: {}"};
inline constexpr LogLine<Text> kMoveItLeftOut{"moveit-left-out", kWarn, "MoveIt's {}"};
inline constexpr LogLine<Text, Text, Text> kMoveItRefused{
    "moveit-refused", kWarn, "a message of MoveIt on {} changes nothing: {}{}"};
inline constexpr LogLine<Text> kMoveItLinesLeftOut{"moveit-lines-left-out", kWarn,
                                                   "{} about messages of MoveIt left out"};
inline constexpr LogLine<Text, Count, Count> kTooManyBodies{
    "too-many-bodies", kError,
    "{} has {} bodies and the cell {} persons: the last person is unknown and stands for the rest"};
inline constexpr LogLine<Text> kBodiesSilent{
    "bodies-silent", kError,
    "a publisher of {} is silent: whether people are there "
    "is unknown"};
inline constexpr LogLine<Text, Count> kSceneResumed{
    "scene-resumed", kInfo, "the scene of {} is resumed: its changes began with revision {:016x}"};
inline constexpr LogLine<Text, Text> kWaitingForDescription{"waiting-for-description", kWarn,
                                                            "waiting for {} {}"};
inline constexpr LogLine<Text, Text> kDescriptionKept{
    "description-kept", kInfo, "the robot's description from {} is kept as {}"};
inline constexpr LogLine<Text, Text> kRobotNote{"robot-note", kInfo, "robot '{}': {}"};
inline constexpr LogLine<Text, Text> kSensorNote{"sensor-note", kInfo, "sensor '{}': {}"};

// ---- The daemon's own recording and log of interventions

inline constexpr LogLine<Text, Text> kRecordingRenamed{"recording-renamed", kWarn,
                                                       "{} exists: recording to {}"};
inline constexpr LogLine<Text> kRecordingWithoutFiles{
    "recording-without-files", kWarn,
    "the recording lacks files that the cell names: {}. A replay needs --cell"};
inline constexpr LogLine<Text> kRecordingContinues{"recording-continues", kInfo,
                                                   "the recording continues in {}"};
inline constexpr LogLine<Text> kEventRecorded{"event-recorded", kInfo, "recording an event to {}"};
inline constexpr LogLine<Text, Text, double> kEventsCapped{
    "events-capped", kInfo,
    "files of events, {}-TIME.mcap, may have {} in all; while one is written, it grows by up to "
    "{:.1f} MB/s, and by what cameras send"};
inline constexpr LogLine<Text> kRecordingStopped{"recording-stopped", kError,
                                                 "the recording stopped: {}"};
inline constexpr LogLine<Text, Text> kDiskTooSlow{
    "disk-too-slow", kError, "recording: the disk is too slow, {} and {} are missing so far"};
inline constexpr LogLine<Text> kDiskHangs{
    "disk-hangs", kError, "recording: the disk takes nothing, {} is left unfinished"};
inline constexpr LogLine<Text, Count, Text> kInterventions{
    "interventions", kInfo, "the log of interventions {} has {} lines and ends with the hash {}"};
inline constexpr LogLine<Text, Text> kInterventionsBroken{
    "interventions-broken", kError,
    "the log of interventions {} is not as it was written, which stays visible: {}"};
inline constexpr LogLine<Text, Count> kInterventionsTorn{
    "interventions-torn", kWarn,
    "the log of interventions {} ended with {} bytes of a line that was not whole: the next line "
    "keeps them"};
inline constexpr LogLine<Text, Text> kInterventionsNotWritten{
    "interventions-not-written", kError, "the log of interventions {} cannot be written: {}"};
inline constexpr LogLine<Text> kInterventionsWritten{
    "interventions-written", kInfo, "the log of interventions {} is written again"};

// ---- Objects

inline constexpr LogLine<Text, Text> kPosesLate{
    "poses-late", kWarn, "the last usable pose of {} is {} old: its pairs are stale"};
inline constexpr LogLine<Text, Text> kResponseLate{
    "response-late", kWarn,
    "{} in the last second had an input beyond response_limit_ms: what depends on it is unknown. "
    "The slowest since the start: {}"};
inline constexpr LogLine<> kResponseBack{"response-back", kInfo,
                                         "the response is within response_limit_ms again"};
inline constexpr LogLine<Text> kPosesContradict{
    "poses-contradict", kWarn,
    "poses of {} contradict each other or the cell: its pairs are unknown"};
inline constexpr LogLine<Text> kPosesBack{"poses-back", kInfo, "poses of {} are back"};
inline constexpr LogLine<Text, Text, Text> kTwoSources{
    "two-sources", kWarn,
    "{} is sent by '{}' and by '{}': poses of the latter are not used, and none while the two "
    "contradict each other, unless 'source' in the cell tells the two apart"};
inline constexpr LogLine<Text, Text, Text> kNewSource{"new-source", kInfo, "{} from source '{}'{}"};
inline constexpr LogLine<Text, Text, Text> kSourceTakenOver{
    "source-taken-over", kWarn, "source '{}' is now writer {}; before, it was writer {}"};
inline constexpr LogLine<Text, Text, Text> kSourceRefused{"source-refused", kWarn,
                                                          "{} of {} are not used: {}"};
inline constexpr LogLine<Text, Count, Count> kOtherRevision{
    "other-revision", kWarn,
    "source '{}' sends poses for scene revision {:016x}, this cell's is {:016x}: not used"};
inline constexpr LogLine<Text, double, std::int64_t, Text, std::int64_t, std::int64_t> kSlowInput{
    "slow-input", kWarn,
    "{} come at {:.1f} Hz, every {} ms, and the age limit of {} is {} ms: late again and again, so "
    "that zones flicker; age_limit_ms of {} would fit"};
inline constexpr LogLine<Text, double, Text> kOtherClock{
    "other-clock", kWarn,
    "{} are stamped {:+.3f} s off the time at which they are sent: by a clock of their own. The "
    "/clock of a simulation needs --use-sim-time here, and use_sim_time at each sender; {} would "
    "take the time at which they are sent"};
inline constexpr LogLine<> kSimTimeAwaited{
    "sim-time-awaited", kWarn,
    "the simulated time is not known, and no input counts: no message of rosgraph_msgs/msg/Clock "
    "has come on rt/clock (use_sim_time)"};
inline constexpr LogLine<double> kSimTimeHeard{"sim-time-heard", kInfo,
                                               "the simulated time is {:.3f} s, by rt/clock"};
inline constexpr LogLine<double> kSimTimeSilent{
    "sim-time-silent", kWarn,
    "rt/clock is silent, after {:.3f} s: the simulation is paused without saying so, or dead. All "
    "inputs are late until newer ones come"};
inline constexpr LogLine<double, double> kSimTimeBack{
    "sim-time-back", kWarn,
    "the simulated time went back from {:.3f} to {:.3f} s: what was heard before does not count"};
inline constexpr LogLine<> kTwoClocks{
    "two-clocks", kWarn,
    "two publishers of rt/clock: the first one counts, until it leaves or is silent. End one"};
inline constexpr LogLine<Text, Text, Text> kSourceChanged{"source-changed", kWarn,
                                                          "{}: sent by '{}' now, before by '{}'"};
inline constexpr LogLine<Text> kVelocitiesContradict{
    "velocities-contradict", kWarn,
    "{}: the velocities that are sent contradict the positions, which are used instead"};
inline constexpr LogLine<Count, Text, Text, Text, Count> kRefused{
    "refused", kWarn, "{} {} refused in the last {}: {} ({} since the start)"};
inline constexpr LogLine<Text> kMoreLeftOut{"more-left-out", kWarn,
                                            "{} about refusals and late inputs left out"};

// ---- Topics and frames of ROS 2

inline constexpr LogLine<Text, Text> kTopicHeard{"topic-heard", kInfo, "{} on {}"};
inline constexpr LogLine<Text> kTopicNotUsed{
    "topic-heard", kWarn,
    "messages of {} are not used: only a daemon or a replay changes the scene"};
inline constexpr LogLine<Text, Count> kTooManyTopics{
    "too-many-topics", kWarn, "{} is one topic of joint states too many: {} are heard"};
inline constexpr LogLine<Text> kNoPositions{
    "no-positions", kInfo, "joint states from '{}' without positions are not used"};
inline constexpr LogLine<Text, Text> kUnknownJoints{
    "unknown-joints", kWarn, "joints from '{}' that the cell does not have are refused: {}"};
inline constexpr LogLine<Text, Text> kUnknownRosJoints{
    "unknown-joints", kInfo,
    "joints from '{}' that no robot of this cell has there are not used: {}"};
inline constexpr LogLine<Text, Text, Text> kFrameRefused{
    "frame-refused", kWarn, "transforms of frame '{}' to '{}' are not used: {}"};
inline constexpr LogLine<Text, Count> kTooManyFrames{
    "too-many-frames", kWarn, "frame '{}' is one too many: {} frames are heard"};
inline constexpr LogLine<Text> kFrameOfTwo{
    "frame-of-two", kWarn,
    "frame '{}' is sent by several publishers that contradict each other: what follows it is "
    "unknown while they do, unless 'source' in the cell tells them apart"};
inline constexpr LogLine<Text, Text, Text, Text> kFrameMoved{
    "frame-moved", kInfo, "frame '{}' hangs on '{}' now, before on '{}'{}"};
inline constexpr LogLine<Text, Text, Text> kFrameMissing{
    "frame-missing", kWarn, "{} is not known: it follows the frame '{}', {}"};
// No transforms at all. The caller adds to the sentence what there is instead.
inline constexpr LogLine<Text, Text, Text> kNoTransforms{
    "no-transforms", kWarn, "{} is not known: it follows the frame '{}', {}"};
inline constexpr LogLine<Text, Text> kFrameFound{"frame-found", kInfo,
                                                 "frame '{}', which {} follows, is there"};

// ---- Sensors

inline constexpr LogLine<Text, Text> kFramesLate{
    "frames-late", kWarn,
    "the last usable frame of sensor {} is {} old: its pairs are stale, or unknown without "
    "max_speed, or where tf has its place"};
inline constexpr LogLine<Text> kFramesUnplaced{
    "frames-unplaced", kWarn,
    "the place of sensor {} is not known: an input of what carries it is contradicted, or so late "
    "that it may be anywhere. Its pairs are unknown until a frame comes that is stamped later"};
inline constexpr LogLine<Text> kFramesBack{"frames-back", kInfo, "frames of sensor {} are back"};
inline constexpr LogLine<Text, Text> kFramesSilent{"frames-silent", kWarn,
                                                   "no usable frame of sensor {} has come: {}"};
inline constexpr LogLine<Text, double, Text> kShellThick{
    "shell-thick", kWarn,
    "sensor {}: what it sees within {:.3f} m of '{}' is left out, since that body may be anywhere "
    "there. Pairs of other objects count what was left out as an obstacle"};

inline constexpr LogLine<Text, Text, std::uint32_t, std::uint32_t> kRobotNotThere{
    "robot-not-there", kError,
    "sensor {} sees through robot '{}' at {} of {} rays that should meet it: the robot, its model "
    "or the sensor is not where it should be. What hangs on the robot is unknown"};
inline constexpr LogLine<Text, Text> kRobotThere{"robot-there", kInfo,
                                                 "sensor {} sees robot '{}' where its joints say"};
inline constexpr LogLine<Text, Text, double, double, double, double, double, double, double, Text>
    kCarriesSomething{
        "carries-something", kWarn,
        "sensor {} sees that '{}' carries something that is no body of the cell, since {:.1f} s: a "
        "box of {:.3f} x {:.3f} x {:.3f} m around ({:.3f}, {:.3f}, {:.3f}) in the frame of the "
        "link. It stays an obstacle. This attaches it: {}"};
inline constexpr LogLine<Text, Text> kCarriesNothing{
    "carries-nothing", kInfo, "sensor {} sees that '{}' does not carry that thing any more"};

// ---- Joints

inline constexpr LogLine<Text, Text, Text> kJointsHeard{"joints-heard", kInfo,
                                                        "positions of {} of {} are heard: {}"};
inline constexpr LogLine<Text, Text, Text> kJointsBack{"joints-back", kInfo,
                                                       "positions of {} of {} are back: {}"};
inline constexpr LogLine<Text, Text, Text, Text> kJointsLate{
    "joints-late", kWarn,
    "the last usable positions of {} of {} are {} old: what hangs on them is stale ({})"};
inline constexpr LogLine<Text, Text, Text> kJointsContradict{
    "joints-contradict", kWarn,
    "positions of {} of {} contradict each other or the limits of the joints: what hangs on them "
    "is unknown ({})"};
inline constexpr LogLine<Text, Text, Text, Text> kTwoJointSources{
    "two-joint-sources", kWarn,
    "joints of {} are sent by '{}' and by '{}': positions of the latter are not used, and none "
    "while the two contradict each other, unless 'source' in the cell tells the two apart ({})"};
inline constexpr LogLine<Text, Text, Text, Text> kJointsSilent{
    "joints-silent", kWarn, "no usable position of {} of {} has come ({}): {}"};

// ---- What grew since the last line about it

inline constexpr LogLine<Text, Count> kBatchesLost{
    "batches-lost", kWarn, "{} lost since the last such line, {} since the start"};
inline constexpr LogLine<Text, Count> kUndecodable{
    "undecodable", kWarn, "{} could not be decoded since the last such line, {} since the start"};
inline constexpr LogLine<Text, Count> kOtherReports{
    "other-reports", kWarn, "{} of other daemons since the last such line, {} since the start"};
inline constexpr LogLine<Text, Count> kOverruns{"overruns", kWarn,
                                                "{} since the last such line, {} since the start"};
inline constexpr LogLine<Text, Count> kReportsDropped{
    "reports-dropped", kWarn, "{} dropped since the last such line, {} since the start"};
inline constexpr LogLine<double> kClockStepped{
    "clock-stepped", kWarn,
    "this machine's clock was stepped by {:+.3f} s. Ages follow a clock that was not stepped. "
    "Sources on this machine are late for half a second; sources on other machines are not"};

// ---- Zones

inline constexpr LogLine<Text, Count> kZoneLeft{"zone-left", kInfo, "zone '{}' left at cycle {}"};
inline constexpr LogLine<Text, Count, Text, Text, Text> kZoneNear{
    "zone-near", kInfo, "zone '{}' entered at cycle {} {}: {}, {}"};
inline constexpr LogLine<Text, Count, Text, Text, Text> kZoneLate{
    "zone-late", kInfo, "zone '{}' entered at cycle {} because {}: {}, {}"};
inline constexpr LogLine<Text, Count, Text, Text> kZoneUnknown{
    "zone-unknown", kInfo, "zone '{}' entered at cycle {} because {}: {} unknown"};
inline constexpr LogLine<Text, Count, Text, Text> kZoneContradicted{
    "zone-contradicted", kInfo, "zone '{}' entered at cycle {} because {}: {} unknown"};
inline constexpr LogLine<Text, Count, Text, Text> kZoneDiscontinuous{
    "zone-discontinuous", kInfo, "zone '{}' entered at cycle {} because {}: {} unknown"};

inline constexpr LogLine<Text, Count, Text, Text> kZoneContactTooDeep{
    "zone-contact-too-deep", kInfo, "zone '{}' entered at cycle {} because {}: {}"};
inline constexpr LogLine<Text, Count, Text, Text> kZoneContactTooLate{
    "zone-contact-too-late", kInfo, "zone '{}' entered at cycle {} because {}: {}"};

inline constexpr LogLine<Text, Count, Text> kZoneFlickers{
    "zone-flickers", kWarn,
    "zone '{}' changed {} more times in the last second; it is {} at present"};
inline constexpr LogLine<Text> kZonesLeftOut{"zones-left-out", kWarn, "{} of zones left out"};

// ---- Contacts that are allowed

inline constexpr LogLine<Text, Text> kContactAllowed{"contact-allowed", kInfo, "{}: {}"};
inline constexpr LogLine<Text, Text> kContactEnded{"contact-ended", kInfo, "{}: {}"};
inline constexpr LogLine<Text, Text> kContactTooDeep{"contact-too-deep", kWarn, "{}: {}"};
inline constexpr LogLine<Text, Text> kContactTooLate{"contact-too-late", kWarn, "{}: {}"};
inline constexpr LogLine<Text> kContactsLeftOut{"contacts-left-out", kWarn,
                                                "{} of contacts left out"};

// ---- DDS and ROS 2

inline constexpr LogLine<Text> kDdsWarning{"dds-warning", kWarn, "dds: {}"};
inline constexpr LogLine<Text> kDdsError{"dds-error", kError, "dds: {}"};
inline constexpr LogLine<Text> kDdsLeftOut{"dds-left-out", kWarn, "dds: {} left out"};
inline constexpr LogLine<Text, Text> kOlderReader{
    "older-reader", kWarn,
    "a reader of {} was built with another version of its type: it gets nothing. Build it with the "
    "IDL of this daemon ({})"};
inline constexpr LogLine<Text, Count> kIncompatibleReader{
    "incompatible-reader", kWarn,
    "a reader of {} asks for QoS that is not offered (policy {}): it gets nothing. Policy 2: only "
    "catalogue, zones and health are latched; idl/README.md has the whole contract"};
inline constexpr LogLine<Text, Text> kOtherTypeWriter{
    "other-type-writer", kWarn,
    "a writer of {} has another type, or another version of it: it is not heard. Build it with the "
    "IDL of this daemon ({})"};
inline constexpr LogLine<Text, Count> kIncompatibleWriter{
    "incompatible-writer", kWarn,
    "a writer of {} offers QoS that does not fit (policy {}): it is not heard. Policy 11: it must "
    "be reliable; idl/README.md has the whole contract"};
inline constexpr LogLine<Text, Count> kWriterAppeared{"writer-appeared", kInfo,
                                                      "a writer of {} appeared: {} now"};
inline constexpr LogLine<Text, Count> kWriterLeft{"writer-left", kInfo,
                                                  "a writer of {} left: {} now"};
inline constexpr LogLine<Text> kInputsFailed{"inputs-failed", kError, "taking inputs failed: {}"};
inline constexpr LogLine<Text, Text, Count> kWriteFailed{
    "write-failed", kError, "writing {} failed: {} ({} failed so far)"};
inline constexpr LogLine<Text, Count> kRosWriteFailed{
    "ros-write-failed", kWarn, "writing for ROS 2 failed: {} ({} failed so far)"};

// ---- Other daemons

inline constexpr LogLine<Text, Text> kOtherDaemonFirst{
    "other-daemon-first", kError,
    "another daemon, {}, publishes on {} and was here first: this one ends"};
inline constexpr LogLine<Text, Text> kOtherDaemonLater{
    "other-daemon-later", kWarn,
    "another daemon, {}, publishes on {} as well; it started later and has to give way"};
inline constexpr LogLine<Text, Text> kOtherProgram{
    "other-program", kWarn,
    "a program that is no daemon (writer {}) publishes on {} as well: clients see both"};
inline constexpr LogLine<Text, Count> kOtherWriterLeft{"other-writer-left", kInfo,
                                                       "another writer of {} has left, {} remain"};

// ---- Partners

inline constexpr LogLine<Text, Text> kPartnerMet{"partner-met", kInfo,
                                                 "partner {} publishes on {} too"};
inline constexpr LogLine<Text> kPartnerStands{"partner-stands", kInfo,
                                              "this daemon is {} among the partners"};
inline constexpr LogLine<Text, Count> kPartnerAgrees{
    "partner-agrees", kInfo,
    "partner '{}' agrees from cycle {} on: the same inputs, the same bits"};
inline constexpr LogLine<Text, Count> kPartnerOtherInputs{
    "partner-other-inputs", kWarn,
    "partner '{}' ticked cycle {} with other inputs: both go on, until one has the other's state"};
inline constexpr LogLine<Text, Count, Count> kPartnerDiffers{
    "partner-differs", kError,
    "partner '{}' reports other bits for cycle {} than this daemon, for the same inputs: one of "
    "the two machines is faulty ({} such reports so far)"};
inline constexpr LogLine<Text, Count, Count> kPartnerCorrupt{
    "partner-corrupt", kError,
    "a report of '{}', cycle {}, came without the checksum that it states: a bit has flipped at "
    "the partner, on the way or here ({} faulty reports so far)"};
inline constexpr LogLine<Text, Count> kPartnerMissing{
    "partner-missing", kWarn, "partner '{}' has not reported cycle {} in time"};
inline constexpr LogLine<Text, std::int64_t> kPartnerClock{
    "partner-clock", kWarn,
    "the clock of partner '{}' differs from this machine's by about {} ms: keep both in step (PTP, "
    "NTP)"};
inline constexpr LogLine<Text, Text, Count> kPartnerNoticeRefused{
    "partner-notice-refused", kWarn,
    "refused {} of partner '{}': no leader can have their times ({} so far)"};
inline constexpr LogLine<Text, Text, Text> kPartnerOtherBuild{
    "partner-other-build", kError,
    "partner '{}' is another build, {}, than this one, {}: neither can take over the other's "
    "state"};
inline constexpr LogLine<Text> kPartnerStateRefused{"partner-state-refused", kWarn,
                                                    "the partner's state is not taken over: {}"};
inline constexpr LogLine<Text> kPartnerFileNotKept{
    "partner-file-not-kept", kWarn, "a file of a command to the partner is not kept here: {}"};

// ---- Shares

inline constexpr LogLine<Text, Count, Text> kShareSceneRefused{
    "share-scene-refused", kError,
    "the scene of the share '{}', revision {:016x}, is not here; this share is not whole: {}"};
inline constexpr LogLine<Text, Text> kShareCatalogueRefused{
    "share-catalogue-refused", kWarn, "messages with the scene of the share '{}' are not used: {}"};
inline constexpr LogLine<Text> kShareAlone{
    "share-alone", kError,
    "the share '{}', which applies the lists of bodies, is gone: all persons are unknown"};

}  // namespace clearance::lines
