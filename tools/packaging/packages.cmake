# CPack makes a Debian package for each component. tools/package calls it.
#   component    package
#   programs     clearance            daemon, tools, unit, example cells, pages
#   view         clearance-view       the page, with its JavaScript
#   Unspecified  libclearance-dev     libraries, headers, IDL, CMake's files
#   python       python3-clearance    the Python package, where pybind11 was found
set(CLEARANCE_MAINTAINER "Clearance" CACHE STRING "Name and address that the packages name as their maintainer")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME clearance)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "${CLEARANCE_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/stage.cmake)

# Example cells belong to the programs.
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
foreach(component programs cells)
  string(TOUPPER ${component} upper)
  set(CPACK_COMPONENT_${upper}_GROUP programs)
endforeach()
set(CPACK_COMPONENT_VIEW_GROUP view)
set(CPACK_COMPONENT_UNSPECIFIED_GROUP development)
set(CPACK_COMPONENT_PYTHON_GROUP python)
get_cmake_property(components COMPONENTS)
set(CPACK_COMPONENTS_ALL programs cells Unspecified)
foreach(optional view python)
  if(optional IN_LIST components)
    list(APPEND CPACK_COMPONENTS_ALL ${optional})
  endif()
endforeach()

# debian_package(GROUP NAME SECTION SUMMARY TEXT): TEXT is the extended description.
macro(debian_package group name section summary text)
  string(TOUPPER ${group} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SHLIBDEPS ON)
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${text}")
endmacro()
set(about "Clearance runs beside a robot controller. A thousand times a second it
publishes the distance of every pair of interest in a robot cell, with a
lower and an upper bound that it has proved. Joint states and poses come
over DDS, also from ROS 2.")
debian_package(programs clearance science "certified distances in robot cells, a thousand times a second"
               "${about}\n.\nThis package has the daemon, its systemd unit and the tools.")
debian_package(view clearance-view science "view of a robot cell and its distances in a browser"
               "${about}\n.\nThis package shows a cell in a browser, live or from a recording.")
debian_package(development libclearance-dev libdevel "certified distances of convex bodies, and client of clearanced"
               "${about}\n.\nThis package has the libraries, headers, message types and CMake files\nfor clients of the daemon, for replays in tests and for distances of\nbodies without DDS.")
debian_package(python python3-clearance python "certified distances in robot cells, from Python"
               "${about}\n.\nThis package has the Python module: distances of bodies and of cells,\nreplay of recordings, and the client of the daemon.")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS "clearance-view")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS "gnuplot-nox, openssl, python3, rt-tests, stress-ng")
set(CPACK_DEBIAN_VIEW_PACKAGE_RECOMMENDS "clearance")
set(CPACK_DEBIAN_VIEW_PACKAGE_SUGGESTS "chromium")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF) # static libraries
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "cyclonedds-dev, libassimp-dev, libeigen3-dev, libfmt-dev, libgmp-dev, libhwy-dev, liblz4-dev, liblzma-dev, libspdlog-dev, libsqlite3-dev, libssl-dev, libtinyxml2-dev, libyaml-cpp-dev, libzstd-dev, zlib1g-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "clearance")
# An extension belongs to one version of Python.
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3-numpy")
if(Python3_VERSION_MINOR)
  math(EXPR next "${Python3_VERSION_MINOR} + 1")
  string(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
         ", python3 (>= 3.${Python3_VERSION_MINOR}~), python3 (<< 3.${next})")
endif()
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "clearance, python3-matplotlib")
set(scripts ${CMAKE_CURRENT_LIST_DIR}/scripts)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_CONTROL_EXTRA "${scripts}/postinst;${scripts}/prerm;${scripts}/postrm")
set(CPACK_CLEARANCE_SOURCE ${CMAKE_CURRENT_LIST_DIR})
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${scripts}/python/postinst;${scripts}/python/prerm")
include(CPack)
