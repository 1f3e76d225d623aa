# Installs the core of BUILD into FOLDER and builds and runs a project that uses it, there.
file(REMOVE_RECURSE "${FOLDER}")
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
run("${CMAKE_COMMAND}" --install "${BUILD}/core" --prefix "${FOLDER}/prefix")
run("${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}" -B "${FOLDER}/build" "-DCMAKE_PREFIX_PATH=${FOLDER}/prefix")
run("${CMAKE_COMMAND}" --build "${FOLDER}/build")
run("${FOLDER}/build/uses_clearance")
