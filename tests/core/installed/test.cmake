# Installs the core of BUILD into FOLDER and builds and runs a project that uses it, there. Eight compilations of a small
# program, some ten seconds: only a compiler can tell.
file(REMOVE_RECURSE "${FOLDER}")
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
run("${CMAKE_COMMAND}" --install "${BUILD}/core" --prefix "${FOLDER}/prefix")
run("${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}" -B "${FOLDER}/build" "-DCMAKE_PREFIX_PATH=${FOLDER}/prefix")
run("${CMAKE_COMMAND}" --build "${FOLDER}/build" --parallel 2)
foreach(user works works_dont_vectorize works_dont_align works_max_align_bytes works_native)
  message("${user}")
  run("${FOLDER}/build/${user}")
endforeach()

# Does not compile, and says why.
function(refused user switch)
  execute_process(COMMAND "${CMAKE_COMMAND}" --build "${FOLDER}/build" --target ${user}
                  OUTPUT_VARIABLE said ERROR_VARIABLE said RESULT_VARIABLE status)
  if(status EQUAL 0 OR NOT said MATCHES "compiled with ${switch}:")
    message(FATAL_ERROR "${user}: expected an error that names ${switch}; found\n${said}")
  endif()
endfunction()
refused(refused_row_major EIGEN_DEFAULT_TO_ROW_MAJOR)
refused(refused_debug_containers _GLIBCXX_DEBUG)

# The build tree has the name of the installed package.
run("${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}/in_build_tree" -B "${FOLDER}/added"
    "-DCLEARANCE=${CMAKE_CURRENT_LIST_DIR}/../../..")
