// SPDX-License-Identifier: MIT
#include "reports/picture_files.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "tests/support/run_program.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;

bool comes_true(const std::function<bool()>& condition) {
  for (int i = 0; i < 2000 && !condition(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return condition();
}

// Draws with programs of our own in place of node and rsvg-convert, in a process that is killed
// while they work.
class KilledDrawing : public ::testing::Test {
 protected:
  // The program says that it is at work by the file "begun".
  void stand_in(const std::string& name, const std::string& work) const {
    const fs::path file = folder_ / "bin" / name;
    testing::write_text(file, "#!/bin/sh\n" + work + "\n: > " + begun().string() + "\nsleep 987\n");
    fs::permissions(file, fs::perms::owner_all);
  }

  void kill_while(const std::function<void()>& draw) const {
    fs::create_directories(out());
    fs::create_directories(temporary());
    const pid_t child = ::fork();
    if (child == 0) {
      const std::string path = (folder_ / "bin").string() + ":" + std::getenv("PATH");
      ::setenv("PATH", path.c_str(), 1);
      ::setenv("TMPDIR", temporary().c_str(), 1);
      draw();
      ::_exit(0);
    }
    EXPECT_TRUE(comes_true([&] { return fs::exists(begun()); }));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
  }

  fs::path begun() const { return folder_ / "begun"; }
  fs::path out() const { return folder_ / "out"; }
  fs::path temporary() const { return folder_ / "temporary"; }

 private:
  testing::TemporaryFolder folder_;
};

TEST_F(KilledDrawing, LeavesNoDataBesideThePictures) {
  stand_in("node", "[ -s \"$2\" ] || exit 1");
  kill_while([&] { draw_picture_files({}, {{"key", "value"}}, out(), {}); });
  EXPECT_TRUE(fs::is_empty(out())) << fs::directory_iterator(out())->path();
  EXPECT_TRUE(comes_true([&] { return fs::is_empty(temporary()); }));
}

TEST_F(KilledDrawing, LeavesNoHalfOfAPng) {
  // As rsvg-convert does: into the file of --output where there is one, else to its output.
  stand_in("rsvg-convert", "[ \"$3\" = --output ] && exec > \"$4\"; echo half");
  kill_while([&] { write_png_beside(out(), {"one.svg"}); });
  EXPECT_TRUE(fs::is_empty(out())) << fs::directory_iterator(out())->path();
}

}  // namespace
}  // namespace tribench
