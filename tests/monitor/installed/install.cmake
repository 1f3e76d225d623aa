# Installs the libraries of BUILD into FOLDER/prefix.
file(REMOVE_RECURSE "${FOLDER}")
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
foreach(room core config idl monitor)
  run("${CMAKE_COMMAND}" --install "${BUILD}/${room}" --component Unspecified --prefix "${FOLDER}/prefix")
endforeach()
