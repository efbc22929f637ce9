#include "common/messages/wiring.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>

namespace nbs {
namespace {

TEST(Wiring, ListsEveryStreamAtItsNumber) {
  ASSERT_EQ(Wiring().size(), std::variant_size_v<Message>);
  for (size_t n = 0; n < Wiring().size(); ++n) EXPECT_EQ(Wiring()[n].stream, n);
}

TEST(Wiring, GivesEveryStreamAChannelAndATypeOfItsOwn) {
  std::set<std::string_view> channels;
  std::set<std::string_view> types;
  for (const StreamWiring& wiring : Wiring()) {
    EXPECT_TRUE(channels.insert(wiring.channel).second) << wiring.channel;
    EXPECT_TRUE(types.insert(wiring.type).second) << wiring.type;
    EXPECT_FALSE(wiring.receivers.empty()) << wiring.channel;
  }
}

std::string Trim(const std::string& text) {
  const size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

// The cells of the rows of a README's table, from below its heading to the first line that is no row.
std::vector<std::vector<std::string>> ReadTable(const std::string& file, const std::string& first_heading_cell) {
  std::ifstream in(file);
  std::vector<std::vector<std::string>> rows;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (!inside) {
      inside = line.starts_with(first_heading_cell);
      continue;
    }
    if (!line.starts_with("|")) break;
    if (line.starts_with("|---")) continue;
    std::istringstream cells(line.substr(1));
    std::vector<std::string>& row = rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, '|');) row.push_back(Trim(cell));
  }
  return rows;
}

TEST(Wiring, IsWhatTheReadmesTableSays) {
  const auto rows =
      ReadTable(NBS_SOURCE_DIR "/lcmtypes/README.md", "| channel | type | sender | receivers | typical rate");
  ASSERT_EQ(rows.size(), Wiring().size());
  for (const StreamWiring& wiring : Wiring()) {
    const auto& row = rows[wiring.stream];
    ASSERT_EQ(row.size(), 6u);
    std::string receivers;
    for (const std::string_view receiver : wiring.receivers)
      receivers += (receivers.empty() ? "" : ", ") + std::string(receiver);
    EXPECT_EQ(row[0], wiring.channel);
    EXPECT_EQ(row[1], wiring.type);
    EXPECT_EQ(row[2], wiring.sender);
    EXPECT_EQ(row[3], receivers);
    EXPECT_FALSE(row[4].empty() || row[5].empty()) << wiring.channel;
  }
}

TEST(Wiring, NamesATypeThatHasItsFile) {
  for (const StreamWiring& wiring : Wiring()) {
    std::ifstream file(NBS_SOURCE_DIR "/lcmtypes/" + std::string(wiring.type) + ".lcm");
    EXPECT_TRUE(file.good()) << wiring.type;
  }
}

// Every field of every message type has a comment beside it.
TEST(Wiring, EveryFieldOfEveryTypeOnAStreamHasAComment) {
  for (const StreamWiring& wiring : Wiring()) {
    std::ifstream file(NBS_SOURCE_DIR "/lcmtypes/" + std::string(wiring.type) + ".lcm");
    for (std::string line; std::getline(file, line);) {
      const bool is_field =
          line.find(';') != std::string::npos && line.starts_with("    ") && !line.starts_with("    const");
      if (!is_field || line.find(" header;") != std::string::npos) continue;
      EXPECT_NE(line.find("// "), std::string::npos) << wiring.type << ": " << line;
    }
  }
}

}  // namespace
}  // namespace nbs
