#include "config/text/printable.hpp"

#include <gtest/gtest.h>

namespace clearance {
namespace {

TEST(Printable, KeepsWhatShowsACharacter) {
  for (const char* text :
       {"", "arm", "a b", "C:\\new", "d\u00e9j\u00e0 vu", "\u6a5f\u68b0", "\U0001F916"}) {
    EXPECT_EQ(text, printable(text));
  }
}

TEST(Printable, EscapesWhatCommandsATerminalOrEndsALine) {
  EXPECT_EQ("a\\x0Ab", printable("a\nb"));
  EXPECT_EQ("\\x0D\\x09\\x7F", printable("\r\t\x7f"));
  EXPECT_EQ("\\x1B[2J", printable("\x1b[2J"));
  EXPECT_EQ("\\x00", printable(std::string_view("\0", 1)));
  EXPECT_EQ("\\xC2\\x9B2J", printable("\u009b2J")) << "CSI of C1";
  EXPECT_EQ("\\xE2\\x80\\xA8", printable("\u2028")) << "a line separator";
  EXPECT_EQ("\\xE2\\x80\\xAE", printable("\u202e")) << "right to left";
  EXPECT_EQ("\\xE2\\x81\\xA9", printable("\u2069")) << "end of an isolate";
}

TEST(Printable, EscapesWhatIsNoUtf8) {
  EXPECT_EQ("a\\xFFb", printable("a\xff"
                                 "b"));
  EXPECT_EQ("\\xC3", printable("\xc3")) << "cut off";
  EXPECT_EQ("\\xC0\\x8A", printable("\xc0\x8a")) << "a line feed in two bytes";
  EXPECT_EQ("\\xED\\xA0\\x80", printable("\xed\xa0\x80")) << "half a surrogate pair";
}

TEST(Printable, KeepsLineBreaksWhereThatIsAskedFor) {
  EXPECT_EQ("a\tb\r\n\\x1B", printable("a\tb\r\n\x1b", LineBreaks::kKept));
}

TEST(Printable, AnExcerptIsTheBeginningOfALongText) {
  EXPECT_EQ("a\\x00", excerpt(std::string_view("a\0", 2)));
  EXPECT_EQ(std::string(300, 'x'), excerpt(std::string(300, 'x')));
  EXPECT_EQ(std::string(300, 'x') + "...", excerpt(std::string(301, 'x')));
}

}  // namespace
}  // namespace clearance
