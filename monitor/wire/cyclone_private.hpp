// Cyclone's private headers: the only file that includes them.
//
// Recordings hold the bytes of the network. Cyclone's public interface neither turns a sample into
// bytes and back (wire/cdr) nor tells the bytes of a sample that it took (participant/cdr_sample).
// These declarations may change with every minor version, so the version is checked here.
#pragma once

#include <dds/ddsi/ddsi_cdrstream.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/version.h>

static_assert(DDS_VERSION_MAJOR == 0 && DDS_VERSION_MINOR == 10,
              "Written for Cyclone DDS 0.10. With another version, compare ddsi_cdrstream.h and "
              "ddsi_serdata.h with their use in wire/cdr.cpp and participant/cdr_sample.cpp, run "
              "the suites Wire, Recorder and OfficialReader, and change the number here and in "
              "idl/CMakeLists.txt.");
