# Plants the slips of this folder into a copy of the tree and goes on there (-DCLEARANCE_MUTANTS=ON).
find_package(Python3 REQUIRED COMPONENTS Interpreter)
set(copy ${PROJECT_BINARY_DIR}/planted)
execute_process(COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/plant ${copy}
                COMMAND_ERROR_IS_FATAL ANY)
file(GLOB_RECURSE planted CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/core/* ${PROJECT_SOURCE_DIR}/config/*
                                            ${PROJECT_SOURCE_DIR}/monitor/* ${CMAKE_CURRENT_LIST_DIR}/*)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${planted})
set(CLEARANCE_MUTANTS OFF)
add_subdirectory(${copy} copy)
