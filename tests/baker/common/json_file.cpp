// json_file.cpp  Faults in a recipe are named by file, line and column, wrong keys and values by their line.
#include "baker/common/files/json_file.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/json_section.hpp"
#include "tests/baker/common/temporary_folder.hpp"

using namespace sinew::baker;

namespace {

std::string refusal(const std::string& text) {
  const sinew::test::TemporaryFolder folder;
  const std::string path = folder.file("r.json");
  std::ofstream(path) << text;
  try {
    const JsonFile file = read_json_file(path);
    JsonSection section(file);
    section.number("size", 0, 0, 1);
    section.rows("rows", 2, 0, 1);
    for (JsonSection& part : section.sections("parts")) {
      part.text("name");
      part.finish();
    }
    section.finish();
    return "read";
  } catch (const BadInput& error) {
    const std::string line = error.what();
    CHECK(line.find('\n') == std::string::npos);
    CHECK(line.find(path) == 0);
    return line.substr(path.size());
  }
}

}  // namespace

TEST_CASE("faults_of_a_json_file_are_named_by_line_and_column") {
  CHECK_THROWS_AS(read_json_file("/nowhere/r.json"), BadInput);
  CHECK_THAT(refusal(""), Catch::StartsWith(":1:1: not JSON: "));
  CHECK_THAT(refusal("hello"), Catch::StartsWith(":1:1: not JSON: "));
  CHECK_THAT(refusal("{\n  \"size\": 0.5\n  \"rows\": []\n}"),
             Catch::StartsWith(":3:8: not JSON: ") && Catch::Contains("expected '}'"));
  CHECK_THAT(refusal("{\n  \"size\": 0.5,\n}"), Catch::StartsWith(":3:1: not JSON: "));
  CHECK_THAT(refusal("{\"size\": 0.5"), Catch::StartsWith(":1:13: not JSON: "));
  CHECK(refusal("{\n  \"size\": 2e308}") == ":2:11: 2e308 is larger than any number can be");
}

TEST_CASE("wrong_keys_and_values_are_named_by_their_line") {
  CHECK(refusal("\n[]") == ":2: must be an object { ... }");
  CHECK_THAT(refusal("{\n// a comment\n\"size\": 2}"), Catch::StartsWith(":3: \"size\" is 2"));
  CHECK_THAT(refusal("{\n\n\"seize\": 2}"), Catch::StartsWith(":3: \"seize\" is not a key"));
  CHECK_THAT(refusal("{\"parts\": [\n{\"name\": \"a\"},\n{\n\"name\": \"b\",\n\"nam\": 1}]}"),
             Catch::StartsWith(":5: parts[1]: \"nam\" is not a key"));
  CHECK_THAT(refusal("{\"parts\": [\n{\"name\": \"a\"},\n{}]}"),
             Catch::StartsWith(":3: parts[1]: \"name\" is missing"));
  CHECK_THAT(refusal("{\"parts\": [\n3]}"), Catch::Contains("parts[0]: must be an object"));
  CHECK_THAT(refusal("{\"rows\": [[0, 1],\n[0, 2]]}"), Catch::StartsWith(":2: rows[1]: "));
  CHECK(refusal("{\"size\": 1, \"rows\": [[0, 1]], \"parts\": [{\"name\": \"a\"}]}") == "read");
}
