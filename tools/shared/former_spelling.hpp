// Command lines as they were before a program had subcommands.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace clearance {

using Words = std::vector<std::string>;

// The option is one of the words, as "--name" or "--name=VALUE".
[[nodiscard]] bool has_option(const Words& words, const std::string& option);

// Removes an option from the words and returns its values: VALUE of "--name=VALUE", or at most
// `most` of the words that follow it and are no options.
Words take_option(Words& words, const std::string& option, std::size_t most);

// The words of a command line, without the program's name.
[[nodiscard]] Words words_of(int argc, char** argv);

// The same command line in its present spelling, after a note on stderr that names it.
[[nodiscard]] Words note_former_spelling(const std::string& program, const std::string& former,
                                         const std::string& subcommand, Words words);

// The pointers that CLI11 parses; valid while the words are.
[[nodiscard]] std::vector<char*> arguments_of(char* program, Words& words);

}  // namespace clearance
