// The types of an IDL text, as far as idl/clearance.idl and the schemas of recordings use IDL.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace clearance {

struct IdlStruct;

struct IdlType {
  enum class Kind : std::uint8_t { kNumber, kString, kSequence, kStruct };
  Kind kind = Kind::kNumber;
  // The spelling of the text with one space between words: "unsigned long", "double", "sequence".
  std::string name;
  std::uint32_t size = 0;                        // of a number, bytes; CDR aligns it to them
  std::shared_ptr<const IdlType> element = {};   // of a sequence
  std::shared_ptr<const IdlStruct> fields = {};  // of a struct; an array has them, named "0" ...
};

struct IdlField {
  std::string name;
  IdlType type;
};

struct IdlStruct {
  std::string name;
  std::vector<IdlField> fields;  // in their order on the wire
};

// Structs by their names without modules.
struct IdlTypes {
  std::string error;  // not empty: what cannot be read
  std::map<std::string, std::shared_ptr<const IdlStruct>, std::less<>> structs;
};

// Reads modules, constants of type unsigned long, and @final structs whose members are numbers,
// strings, sequences and structs defined before, or arrays of one dimension of these. Anything else
// is an error: a layout that is not understood must not be guessed.
[[nodiscard]] IdlTypes parse_idl(std::string_view text);

}  // namespace clearance
