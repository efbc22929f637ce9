#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "common/runtime/error.h"

namespace nbs {

/// A folder of the test's own, empty at first.
inline std::filesystem::path MakeTestFolder() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / (std::string("nbs_") + test->test_suite_name() + "_" + test->name());
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

inline std::filesystem::path WriteTestFile(const std::string& name, const std::string& text) {
  const std::filesystem::path file = MakeTestFolder() / name;
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

/// The sentence of the ConfigError that `action` ends in, without the folder; "no error" if there is none.
template <typename Action>
std::string CatchConfigError(const Action& action) {
  try {
    action();
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    const size_t slash = text.substr(0, text.find(": ")).rfind('/');
    return slash == std::string::npos ? text : text.substr(slash + 1);
  }
  return "no error";
}

}  // namespace nbs
