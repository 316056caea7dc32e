// SPDX-License-Identifier: MIT
//
// A made-up run with everything a report must show: a clear winner, a tie, a singular formula with
// its witness, failed and missing cells, a fixed form beside two operator sets.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/record/loop_record.hpp"
#include "reports/record/record.hpp"

namespace tribench {

std::vector<Record> sample_records(std::uint64_t seeds);

// A folder of its own under the test's temporary directory, emptied first.
std::filesystem::path fresh_folder(const std::string& name);

// Writes results.csv, planned.csv, provenance.json and grid.toml of the sample run.
void write_sample_run(const std::filesystem::path& folder, std::uint64_t seeds);

// Two effects, an alias, something left over, and a picture of every kind.
LoopRecord sample_loop();

std::string text_of(const std::filesystem::path& file);

// Compares with tests/golden/<name>; TRIBENCH_UPDATE_GOLDEN=1 in the environment writes it anew.
void expect_golden(const std::string& text, const std::string& name);

}  // namespace tribench
