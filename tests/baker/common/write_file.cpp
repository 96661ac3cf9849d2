// write_file.cpp  Whole files or none.
#include "baker/common/files/write_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <vector>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/read_file.hpp"
#include "tests/baker/common/temporary_folder.hpp"

using namespace sinew::baker;
using Catch::Contains;
using sinew::test::TemporaryFolder;

namespace {

std::string refusal(const std::string& path, std::string_view text) {
  try {
    write_file(path, text);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

// Files of this process may not grow beyond `bytes` while it lives: what a full disk looks like to write().
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

}  // namespace

TEST_CASE("write_file_refuses_places_it_cannot_write_with_one_line") {
  const TemporaryFolder folder;
  CHECK_THAT(refusal(folder.file("no/such/folder/x"), "text"),
             Contains("no/such/folder/x: cannot be written"));
  CHECK_THAT(refusal(folder.path(), "text"), Contains("it is a directory"));
  CHECK_THAT(refusal("", "text"), Contains("cannot be written"));
  CHECK(folder.entries() == 0);
}

TEST_CASE("a_full_disk_leaves_the_old_file_and_nothing_half_written") {
  const TemporaryFolder folder;
  write_file(folder.file("pack"), std::string_view("old"));
  const std::string big(1 << 20, 'x');
  {
    const FileSizeLimit limit(4096);
    CHECK_THAT(refusal(folder.file("pack"), big), Contains("pack: cannot be written (File too large)"));
    CHECK_THAT(refusal(folder.file("new"), big), Contains("cannot be written"));
  }
  CHECK(read_text(folder.file("pack")) == "old");
  CHECK(folder.entries() == 1);
}

TEST_CASE("write_file_replaces_a_file_whole_and_keeps_a_link_a_link") {
  const TemporaryFolder folder;
  write_file(folder.file("target"), std::string_view("first, and longer"));
  std::filesystem::create_symlink(folder.file("target"), folder.file("link"));
  write_file(folder.file("link"), std::string_view("second"));
  CHECK(read_text(folder.file("target")) == "second");
  CHECK(std::filesystem::is_symlink(folder.file("link")));
  CHECK(folder.entries() == 2);
}

namespace {

// Of the process id too, which is the same again in every container.
std::string left_part(const TemporaryFolder& folder, const std::string& end) {
  const std::string path = folder.file("pack.part-" + end);
  write_file(path, std::string_view("half"));
  return path;
}

}  // namespace

TEST_CASE("what_a_killed_process_left_of_a_file_is_removed_and_keeps_nobody_from_writing_it") {
  const TemporaryFolder folder;
  const std::string old = left_part(folder, std::to_string(::getpid())),
                    left = left_part(folder, "0123456789abcdef01234567"),
                    foreign = left_part(folder, "0123456789abcdef0123456x"),
                    link = folder.file("pack.part-aaaaaaaaaaaaaaaaaaaaaaaa"),
                    precious = folder.file("precious");
  write_file(precious, std::string_view("precious"));
  std::filesystem::create_symlink(precious, link);
  write_file(folder.file("pack"), std::string_view("new"));
  CHECK(read_text(folder.file("pack")) == "new");
  CHECK_FALSE(std::filesystem::exists(left));
  CHECK(read_text(foreign) == "half");
  CHECK(read_text(old) == "half");  // of an older version, or anybody's
  CHECK(read_text(precious) == "precious");
  CHECK(std::filesystem::is_symlink(link));
}

TEST_CASE("what_another_process_still_writes_is_left_to_it") {
  const TemporaryFolder folder;
  const std::string part = left_part(folder, "0123456789abcdef01234567");
  const int held = ::open(part.c_str(), O_WRONLY | O_CLOEXEC);
  REQUIRE(::flock(held, LOCK_EX | LOCK_NB) == 0);
  write_file(folder.file("pack"), std::string_view("new"));
  CHECK(std::filesystem::exists(part));
  ::close(held);
  write_file(folder.file("pack"), std::string_view("newer"));
  CHECK_FALSE(std::filesystem::exists(part));
}

TEST_CASE("of_several_who_write_one_file_at_once_one_is_last_and_whole") {
  const TemporaryFolder folder;
  const std::string path = folder.file("pack");
  std::vector<pid_t> writers;
  for (char c : {'a', 'b', 'c', 'd'}) {
    const pid_t writer = ::fork();
    if (writer == 0) {
      bool written = true;
      for (int time = 0; time < 40; ++time)
        written = written && refusal(path, std::string(200000, c)).empty();
      ::_exit(written ? 0 : 1);
    }
    writers.push_back(writer);
  }
  for (int time = 0; time < 400; ++time) {
    if (!std::filesystem::exists(path)) continue;
    const std::string text = read_text(path);
    REQUIRE(text.size() == 200000);
    REQUIRE(text.find_first_not_of(text[0]) == std::string::npos);
  }
  for (const pid_t writer : writers) {
    int status = -1;
    REQUIRE(::waitpid(writer, &status, 0) == writer);
    CHECK(status == 0);
  }
  CHECK(folder.entries() == 1);
}

TEST_CASE("a_writer_that_is_killed_is_no_hindrance_to_the_next") {
  const TemporaryFolder folder;
  const std::string path = folder.file("pack");
  for (int time = 0; time < 20; ++time) {
    const pid_t writer = ::fork();
    if (writer == 0)
      for (;;) write_file(path, std::string(400000, 'x'));
    ::usleep(2000 + 700 * static_cast<useconds_t>(time));
    ::kill(writer, SIGKILL);
    ::waitpid(writer, nullptr, 0);
    CHECK(refusal(path, "whole").empty());
    CHECK(read_text(path) == "whole");
    CHECK(folder.entries() == 1);
  }
}

TEST_CASE("a_device_is_written_to_and_not_replaced") {
  write_file("/dev/null", std::string_view("text"));
  CHECK(std::filesystem::is_character_file("/dev/null"));
}

TEST_CASE("read_file_names_what_it_cannot_read") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(read_file(folder.file("missing")),
                    Contains("missing: cannot be read (No such file or directory)"));
  CHECK_THROWS_WITH(read_file(folder.path()), Contains("it is a directory"));
  write_file(folder.file("empty"), std::string_view(""));
  CHECK(read_file(folder.file("empty")).empty());
}

TEST_CASE("a_folder_is_made_with_those_above_it_and_refused_where_a_file_is_or_nothing_may_be") {
  const TemporaryFolder folder;
  const std::string deep = folder.path() + "/a/b/c";
  make_folder(deep);
  make_folder(deep);  // it is there already
  write_file(deep + "/file", "here");
  CHECK_THROWS_WITH(make_folder(deep + "/file"), Contains(deep + "/file: cannot be made a folder"));
  CHECK_THROWS_WITH(make_folder("/proc/none"), Contains("/proc/none: cannot be made a folder"));
}
