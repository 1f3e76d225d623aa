#include "tools/shared/former_spelling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "monitor/app/print.hpp"

namespace clearance {
namespace {

Words::const_iterator find_option(const Words& words, const std::string& option) {
  return std::ranges::find_if(words, [&option](const std::string& word) {
    return word == option || word.starts_with(option + "=");
  });
}

}  // namespace

bool has_option(const Words& words, const std::string& option) {
  return find_option(words, option) != words.end();
}

Words take_option(Words& words, const std::string& option, std::size_t most) {
  const auto found = find_option(words, option);
  if (found == words.end()) return {};
  auto end = found + 1;
  Words values;
  if (const std::size_t equals = found->find('='); equals != std::string::npos) {
    values.push_back(found->substr(equals + 1));
  }
  while (values.size() < most && end != words.end() && !end->starts_with('-')) {
    values.push_back(*end++);
  }
  words.erase(found, end);
  return values;
}

Words words_of(int argc, char** argv) { return {argv + 1, argv + argc}; }

Words note_former_spelling(const std::string& program, const std::string& former,
                           const std::string& subcommand, Words words) {
  words.insert(words.begin(), subcommand);
  const std::string present = fmt::format("{}", fmt::join(words, " "));
  print(stderr, "{0}: note: '{0} {1}' is now spelled '{0} {2}'\n", program, former, present);
  return words;
}

std::vector<char*> arguments_of(char* program, Words& words) {
  std::vector<char*> arguments = {program};
  for (std::string& word : words) arguments.push_back(word.data());
  return arguments;
}

}  // namespace clearance
