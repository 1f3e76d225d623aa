# Installs the libraries of BUILD into FOLDER, builds there the example client as it was installed, and runs it beside the
# daemon on an installed cell. The lines under README's "As a client" are the example's own.
include("${CMAKE_CURRENT_LIST_DIR}/install.cmake")
set(share "${FOLDER}/prefix/share/clearance")
run("${CMAKE_COMMAND}" -S "${share}/example" -B "${FOLDER}/build" "-DCMAKE_PREFIX_PATH=${FOLDER}/prefix")
run("${CMAKE_COMMAND}" --build "${FOLDER}/build")
run("${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}/types" -B "${FOLDER}/build_types"
    "-DCMAKE_PREFIX_PATH=${FOLDER}/prefix")
run("${CMAKE_COMMAND}" --build "${FOLDER}/build_types")
run("${FOLDER}/build_types/uses_types")

# Side by side: the client ends by itself, the daemon a while later.
string(RANDOM LENGTH 12 partition)
execute_process(COMMAND "${FOLDER}/build/client" "${partition}" 4
                COMMAND "${BUILD}/bin/clearanced" "${share}/cells/seven_joint_arms.yaml" --partition "${partition}"
                        --ticks 8000
                OUTPUT_VARIABLE summary RESULTS_VARIABLE results)
if(NOT results STREQUAL "0;0")
  message(FATAL_ERROR "client and daemon ended with ${results}: ${summary}")
endif()
file(READ "${SOURCE}/monitor/examples/slowing_arm/client.cpp" example)
file(READ "${SOURCE}/README.md" readme)
string(FIND "${readme}" "## As a client" chapter)
string(SUBSTRING "${readme}" ${chapter} -1 readme)
string(FIND "${readme}" "```cpp\n" begin)
math(EXPR begin "${begin} + 7")
string(SUBSTRING "${readme}" ${begin} -1 readme)
string(FIND "${readme}" "```" end)
string(SUBSTRING "${readme}" 0 ${end} shown)
string(FIND "${example}" "${shown}" place)
if(end LESS 200 OR place EQUAL -1)
  message(FATAL_ERROR "README.md shows lines under \"As a client\" that monitor/examples/slowing_arm/client.cpp does not have")
endif()
