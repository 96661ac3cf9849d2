// mapped_file.cpp  Files are mapped whole or refused with the system's reason.
#include "pack/mapped_file.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <utility>

#include "baker/common/files/write_file.hpp"
#include "tests/baker/common/temporary_folder.hpp"

using namespace sinew;
using Catch::Contains;
using pack::MappedFile;
using test::TemporaryFolder;

TEST_CASE("what_cannot_be_mapped_is_refused_with_path_and_reason") {
  const TemporaryFolder folder;
  MappedFile file;
  CHECK(MappedFile::open(nullptr, &file).code == StatusCode::kInvalidArgument);

  const Status missing = MappedFile::open(folder.file("missing.sinew").c_str(), &file);
  CHECK(missing.code == StatusCode::kUnreadable);
  CHECK_THAT(missing.message, Contains("missing.sinew: cannot be read (No such file or directory)"));

  const Status directory = MappedFile::open(folder.path().c_str(), &file);
  CHECK(directory.code == StatusCode::kUnreadable);
  CHECK_THAT(directory.message, Contains("not a regular file"));

  REQUIRE(::mkfifo(folder.file("pipe").c_str(), 0600) == 0);
  CHECK(MappedFile::open(folder.file("pipe").c_str(), &file).code == StatusCode::kUnreadable);
  CHECK(file.bytes().empty());
}

TEST_CASE("a_refused_file_leaves_the_mapping_as_it_was") {
  const TemporaryFolder folder;
  baker::write_file(folder.file("a"), std::string_view("content"));
  MappedFile file;
  REQUIRE(MappedFile::open(folder.file("a").c_str(), &file).ok());
  CHECK_FALSE(MappedFile::open(folder.file("b").c_str(), &file).ok());
  CHECK_FALSE(MappedFile::open(folder.path().c_str(), &file).ok());
  REQUIRE(file.bytes().size() == 7);
  CHECK(file.bytes()[6] == std::byte{'t'});
}

TEST_CASE("a_mapping_moves_and_an_empty_file_maps_to_nothing") {
  const TemporaryFolder folder;
  baker::write_file(folder.file("a"), std::string_view("content"));
  baker::write_file(folder.file("empty"), std::string_view(""));
  MappedFile file;
  REQUIRE(MappedFile::open(folder.file("a").c_str(), &file).ok());
  MappedFile moved(std::move(file));
  CHECK(moved.bytes().size() == 7);
  REQUIRE(MappedFile::open(folder.file("empty").c_str(), &moved).ok());
  CHECK(moved.bytes().empty());
}
