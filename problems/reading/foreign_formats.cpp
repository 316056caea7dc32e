// SPDX-License-Identifier: MIT
#include "problems/reading/foreign_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include "foundation/error.hpp"
#include "foundation/text.hpp"
#include "problems/reading/csv_scanner.hpp"

namespace tribench {
namespace {

constexpr std::string_view kBagToCsv =
    "python3 adapters/ros_to_csv.py {} --joint NAME -o log.csv makes a table of it";

struct Foreign {
  std::string_view begins;
  std::string_view what;
  std::string_view mend;  // {}: the file
};

constexpr std::array kForeign = {
    Foreign{"BZh", "this is packed by bzip2", "unpack it: bunzip2 -k '{}'"},
    Foreign{"\xFD"
            "7zXZ",
            "this is packed by xz", "unpack it: unxz -k '{}'"},
    Foreign{"\x28\xB5\x2F\xFD", "this is packed by zstd", "unpack it: unzstd '{}'"},
    Foreign{"7z\xBC\xAF", "this is a 7z archive", "unpack it: 7z x '{}'"},
    Foreign{"Rar!", "this is a rar archive", "unpack it: unrar x '{}'"},
    Foreign{"MATLAB 5.0 MAT-file", "this is a file of MATLAB's",
            "in MATLAB: writematrix or writetable what it holds to a .csv file"},
    Foreign{"\x89HDF", "this is an HDF5 file (as MATLAB's of version 7.3)",
            "write what it holds to a .csv file: in MATLAB by writetable, in pandas by "
            "read_hdf('{}').to_csv('log.csv')"},
    Foreign{
        "\x93NUMPY", "this is an array of numpy's",
        "in Python: numpy.savetxt('log.csv', numpy.load('{}'), delimiter=',', header='t,q,tau', "
        "comments='')"},
    Foreign{"PAR1", "this is a Parquet file",
            "in pandas: read_parquet('{}').to_csv('log.csv', index=False)"},
    Foreign{"\xD0\xCF\x11\xE0", "this is a workbook of Excel's", "save its sheet as CSV"},
    Foreign{"TDSm", "this is a TDMS file of LabVIEW's",
            "export it as CSV, or in Python with nptdms: "
            "TdmsFile.read('{}').as_dataframe().to_csv('log.csv')"},
    Foreign{"SQLite format 3", "this is an SQLite file, as a bag of ROS 2", kBagToCsv},
    Foreign{"\x89MCAP", "this is a bag of ROS 2", kBagToCsv},
    Foreign{"#ROSBAG", "this is a bag of ROS 1",
            "write its topic as CSV: rostopic echo -b '{}' -p "
            "/joint_states > log.csv"},
};

[[noreturn]] void refuse_format(std::string_view what, std::string_view mend,
                                std::string_view file) {
  throw_bad_input(std::string(what), std::string(file), fmt::format(fmt::runtime(mend), file));
}

void refuse_zip(std::string_view bytes, std::string_view file) {
  constexpr std::size_t kName = 30;  // the first entry's
  const std::string_view begin = bytes.substr(0, 200);
  const std::string_view first = begin.substr(std::min(kName, begin.size()));
  if (bytes.find("xl/workbook") != std::string_view::npos ||
      first.find("opendocument.spreadsheet") != std::string_view::npos) {
    refuse_format("this is a workbook of a spreadsheet",
                  "save its sheet as CSV (in pandas: read_excel('{}').to_csv('log.csv', "
                  "index=False))",
                  file);
  }
  if (first.find(".npy") != std::string_view::npos) {
    refuse_format("these are arrays of numpy's",
                  "in Python: d = numpy.load('{}'); pandas.DataFrame({{k: d[k] for k in "
                  "d}}).to_csv('log.csv', index=False)",
                  file);
  }
  refuse_format("this is a zip archive", "unpack it (unzip '{}') and give the files in it", file);
}

}  // namespace

void refuse_foreign_bytes(std::string_view bytes, std::string_view file) {
  if (bytes.starts_with("PK\x03\x04")) refuse_zip(bytes, file);
  for (const Foreign& foreign : kForeign) {
    if (!bytes.starts_with(foreign.begins)) continue;
    const bool is_text = bytes.find('\0') == std::string_view::npos && is_utf8(bytes);
    if (!is_text) refuse_format(foreign.what, foreign.mend, file);
  }
  constexpr std::size_t kTarMark = 257;
  if (bytes.size() > kTarMark && bytes.substr(kTarMark).starts_with("ustar")) {
    refuse_format("this is a tar archive", "unpack it (tar xf '{}') and give the files in it",
                  file);
  }
}

void refuse_foreign_text(std::string_view first, std::string_view file, std::size_t line) {
  first = trimmed(first);
  constexpr std::string_view kNames = "write a line of names and then the numbers (in pandas: ";
  if (first.starts_with('{')) {
    throw_bad_input("these are JSON objects, no table", csv_place(file, line),
                    fmt::format("{}read_json(FILE, lines=True).to_csv(OTHER))", kNames));
  }
  std::string dense;
  for (const char c : first.substr(0, 20)) {
    if (c != ' ') dense += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (dense == "[" || dense.starts_with("[{") || dense.starts_with("[[")) {
    throw_bad_input("this is a JSON array, no table", csv_place(file, line),
                    fmt::format("{}read_json(FILE).to_csv(OTHER, index=False))", kNames));
  }
  for (const std::string_view tag : {"<!doctype", "<html", "<table", "<?xml"}) {
    if (!dense.starts_with(tag)) continue;
    throw_bad_input("this is HTML or XML, no table of text", csv_place(file, line),
                    fmt::format("{}read_html(FILE)[0].to_csv(OTHER, index=False))", kNames));
  }
}

void refuse_folder(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(file, ignored)) return;
  const std::string folder = file.has_filename() ? file.string() : file.parent_path().string();
  std::string ending;
  for (const auto& entry : std::filesystem::directory_iterator(file, ignored)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".mcap" || extension == ".db3") {
      throw_bad_input("this is a folder with a bag of ROS 2", folder,
                      fmt::format(fmt::runtime(kBagToCsv), folder));
    }
    const bool is_table = extension == ".csv" || extension == ".txt" || extension == ".dat";
    if (is_table && ending != ".csv") ending = extension;
  }
  throw_bad_input(
      "this is a folder", folder,
      ending.empty() ? "give a file" : fmt::format("give its files: {}/*{}", folder, ending));
}

}  // namespace tribench
