# Run by every build: writes the name of this build to OUT, if it is not there already.
#   cmake -D SOURCE=... -D IN=... -D OUT=... -D VERSION=... -D COMPILED=... -P build_info.cmake
# The state of the sources as git names it. It is empty when the sources are not a git checkout of
# their own.
execute_process(COMMAND git rev-parse --show-prefix WORKING_DIRECTORY ${SOURCE}
                OUTPUT_VARIABLE prefix RESULT_VARIABLE no_checkout ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
if(no_checkout EQUAL 0 AND prefix STREQUAL "")
  execute_process(COMMAND git --no-optional-locks describe --always --dirty --abbrev=12 WORKING_DIRECTORY ${SOURCE}
                  OUTPUT_VARIABLE state ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
endif()
string(JOIN ", " CLEARANCE_BUILD ${VERSION} ${state} ${COMPILED})
configure_file(${IN} ${OUT} @ONLY)
