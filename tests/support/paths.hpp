// SPDX-License-Identifier: MIT
//
// Where the tests find things. One small library knows the absolute paths, so that a test's object
// file does not depend on where the checkout lies.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace tribench::testing {

std::filesystem::path source_dir();    // the checkout
std::filesystem::path program();       // the built tribench
std::filesystem::path test_program();  // the same with the methods of support/test_methods.hpp

// The measured data beside the checkout (../shared/data), if they are there. A test that needs
// them: const auto data = shared_data(); if (!data) GTEST_SKIP() << kNoSharedData;
std::optional<std::filesystem::path> shared_data();
// The reference material beside the checkout (../shared/reference), if it is there.
std::optional<std::filesystem::path> shared_reference();
// A public suite beside the checkout (../shared/suites/NAME), if it is there.
std::optional<std::filesystem::path> shared_suite(const std::string& name);

// A folder of this process's own, made when first asked for and removed when it ends. Not
// ::testing::TempDir(), which everybody's tests share.
const std::filesystem::path& scratch_folder();

inline constexpr const char* kNoSharedData =
    "no measured data: ../shared is not beside the checkout";

}  // namespace tribench::testing
