# Writes FILE, which declares a test of ctest for each suite of PROGRAM: what clearance_suites() in CMakeLists.txt runs.
# PROGRAM is a list: its emulator comes first, where it was built for another processor.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests "--gtest_filter=${FILTER}" OUTPUT_VARIABLE listed
                COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "[][;]" "" listed "${listed}") # in values of parameters; they would part a list
string(REPLACE "\n" ";" lines "${listed}")
set(suite "")
set(declared "")
set(exclude "")
if(FILTER MATCHES "(-.*)$") # A filter's excluded part counts in each suite, too.
  set(exclude "${CMAKE_MATCH_1}")
endif()
foreach(line ${lines})
  if(line MATCHES "^([^ ]+)\\.( |$)")
    set(suite "${CMAKE_MATCH_1}")
  elseif(NOT line MATCHES "^  DISABLED_" AND line MATCHES "^  ([^ ]+)") # the last match counts
    list(APPEND cases_${suite} "${CMAKE_MATCH_1}")
    list(APPEND suites ${suite})
  endif()
endforeach()
list(REMOVE_DUPLICATES suites)
foreach(suite ${suites})
  list(LENGTH cases_${suite} count)
  if(suite MATCHES "^(Kinds/LyingInputs|UnknownPayloads|SilentWords|SecondWitness|RelayedCommands|DaemonJoints|CameraFaults|Watch)$")
    set(count 500) # The longest begin before most others.
  endif()
  set(weight "")
  # No cycle may be missing between partners, so no more than one suite computes beside them. They begin early: once the
  # other suites run, three of the five places are never free at once.
  if(suite MATCHES "Partners$")
    set(weight "PROCESSORS 3")
    set(count 2000)
  endif()
  if(exclude STREQUAL "")
    list(TRANSFORM cases_${suite} PREPEND "${suite}.")
    list(JOIN cases_${suite} ":" filter) # only those of FILTER
  else()
    set(filter "${suite}.*${exclude}")
  endif()
  string(APPEND declared "add_test([==[${PREFIX}/${suite}]==] ${PROGRAM} [==[--gtest_filter=${filter}]==])\n"
                         "set_tests_properties([==[${PREFIX}/${suite}]==] PROPERTIES TIMEOUT 900 COST ${count} "
                         "${PROPERTIES} ${weight} FAIL_REGULAR_EXPRESSION \"0 tests from 0 test suites ran\")\n")
endforeach()
file(WRITE ${FILE} "${declared}")
