// pack_writer.cpp  Where sections lie, and that equal content has equal bytes.
#include "baker/pack/pack_writer.hpp"

#include <catch2/catch.hpp>

#include "pack/section_table.hpp"
#include "tests/pack/pack_editor.hpp"

using namespace sinew;
using namespace sinew::baker;
using pack::SectionKind;

TEST_CASE("sections_ascend_on_64_byte_boundaries_with_zeros_between") {
  PackWriter writer(pack::FileKind::kModel);
  writer.section(SectionKind::kWeights, std::vector<float>{1, 2, 3});
  writer.section(SectionKind::kMetadata, std::vector<char>{'{', '}'});
  writer.section(SectionKind::kInputs, std::vector<pack::InputRecord>{});
  test::PackEditor editor(writer.finish());
  pack::SectionTable table;
  REQUIRE(pack::read_section_table(editor.bytes(), &table).ok());
  REQUIRE(editor.table().size() == 2);  // the empty one is left out
  CHECK(editor.table()[0].kind == static_cast<uint32_t>(SectionKind::kMetadata));
  CHECK(editor.table()[0].offset == 128);
  CHECK(editor.table()[1].offset == 192);
  CHECK(editor.bytes().size() == 256);
  CHECK(table.get<float>(SectionKind::kWeights)[2] == 3.0f);
}

TEST_CASE("elements_of_several_numbers_are_counted_as_elements") {
  PackWriter writer(pack::FileKind::kCharacter);
  writer.section(SectionKind::kPositions, std::vector<float>(12), 3);
  test::PackEditor editor(writer.finish());
  CHECK(editor.table()[0].count == 4);
  CHECK(editor.table()[0].element_bytes == 12);
}

TEST_CASE("equal_texts_share_one_string_and_a_suffix_is_not_equal") {
  PackWriter writer(pack::FileKind::kModel);
  const uint32_t tail = writer.string("left_tail");
  CHECK(writer.string("left_tail") == tail);
  CHECK(writer.string("tail") != tail + 5);
  CHECK(writer.string("tail") == writer.string("tail"));
  CHECK(writer.string("") == writer.string(""));
}

TEST_CASE("an_empty_pack_is_a_header_that_the_table_reader_takes") {
  test::PackEditor editor(PackWriter(pack::FileKind::kModel).finish());
  pack::SectionTable table;
  CHECK(editor.bytes().size() == 64);
  CHECK(pack::read_section_table(editor.bytes(), &table).ok());
  CHECK(editor.open().code == StatusCode::kCorrupt);
}
