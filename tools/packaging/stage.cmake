# Runs before CPack makes the packages: gives every package its copyright and changelog, compresses man pages and strips
# the static libraries of what only debuggers need. What is packaged does not depend on the folder, the time or the user.
# Debian's form of the changelog names the versions: "## 0.2.0, Tue, 24 Nov 2026".
file(STRINGS ${CPACK_CLEARANCE_SOURCE}/CHANGELOG.md versions REGEX "^## ")
set(changes "")
foreach(version ${versions})
  string(REGEX MATCH "^## ([0-9.]+), (.+)$" found "${version}")
  string(APPEND changes "clearance (${CMAKE_MATCH_1}-${CPACK_DEBIAN_PACKAGE_RELEASE}) UNRELEASED; urgency=medium\n\n"
                        "  * changelog.gz says what changed.\n\n"
                        " -- ${CPACK_PACKAGE_CONTACT}  ${CMAKE_MATCH_2} 12:00:00 +0000\n\n")
endforeach()

set(packages programs clearance view clearance-view development libclearance-dev python python3-clearance)
while(packages)
  list(POP_FRONT packages group name)
  set(root ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/${group})
  if(NOT IS_DIRECTORY ${root})
    continue()
  endif()
  if(name STREQUAL clearance)
    file(MAKE_DIRECTORY ${root}/etc/clearance) # the cells of the unit
  endif()
  set(doc ${root}/usr/share/doc/${name})
  configure_file(${CPACK_CLEARANCE_SOURCE}/copyright ${doc}/copyright COPYONLY NO_SOURCE_PERMISSIONS)
  configure_file(${CPACK_CLEARANCE_SOURCE}/CHANGELOG.md ${doc}/changelog COPYONLY NO_SOURCE_PERMISSIONS)
  configure_file(${CPACK_CLEARANCE_SOURCE}/VERSIONS.md ${doc}/VERSIONS.md COPYONLY NO_SOURCE_PERMISSIONS)
  file(WRITE ${doc}/changelog.Debian "${changes}")
  file(GLOB pages ${root}/usr/share/man/man1/*.1)
  execute_process(COMMAND gzip -9nf ${doc}/changelog ${doc}/changelog.Debian ${pages} COMMAND_ERROR_IS_FATAL ANY)
  # idlc writes the folder of the build into its headers.
  file(GLOB headers ${root}/usr/include/clearance/idl/*.h)
  foreach(header ${headers})
    file(READ ${header} text)
    string(REGEX REPLACE "(File name|Source): [^\n]*/" "\\1: " text "${text}")
    string(REGEX REPLACE "DDSC_[A-Z0-9_]*_IDL_" "DDSC_CLEARANCE_IDL_" text "${text}")
    file(WRITE ${header} "${text}")
  endforeach()
  file(GLOB_RECURSE libraries ${root}/usr/lib/*.a)
  foreach(library ${libraries})
    execute_process(COMMAND strip --strip-debug --remove-section=.comment --remove-section=.note --enable-deterministic-archives
                            ${library} COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
endwhile()
