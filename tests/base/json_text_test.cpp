#include "softcell/base/json_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace softcell::base {
namespace {

using nlohmann::json;

TEST(JsonText, WritesNumbersWithoutFloats) {
  JsonText text;
  text.microseconds(0).raw(" ").microseconds(7).raw(" ").microseconds(1'000'060).raw(" ").microseconds(-5);
  EXPECT_EQ(text.text(), "0.000 0.007 1000.060 0.000");
  EXPECT_EQ(JsonText().hex(0xBEEF, 5).text(), "\"0x0BEEF\"");
  EXPECT_EQ(JsonText().hex(0x123456789ABCDEF0, 12).text(), "\"0x123456789ABCDEF0\"");
}

TEST(JsonText, MakesValidUtf8OfAnyBytes) {
  EXPECT_EQ(JsonText().string("caf\xC3\xA9 \xF0\x9F\x8E\xAE").text(), "\"caf\xC3\xA9 \xF0\x9F\x8E\xAE\"");
  for (int first = 0; first < 256; ++first) {
    for (const int second : {0x00, 0x41, 0x80, 0x8F, 0x90, 0x9F, 0xA0, 0xBF, 0xC0, 0xFF}) {
      const std::string bytes{static_cast<char>(first), static_cast<char>(second), '\x80', '\x80'};
      for (std::size_t length = 1; length <= bytes.size(); ++length) {
        EXPECT_TRUE(json::accept(JsonText().string(bytes.substr(0, length)).text()))
            << first << " " << second;
      }
    }
  }
}

}  // namespace
}  // namespace softcell::base
