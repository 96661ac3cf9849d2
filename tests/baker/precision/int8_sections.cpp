// int8_sections.cpp  Int8 sections that do not fit their network are refused by name.
#include <catch2/catch.hpp>
#include <functional>
#include <limits>

#include "baker/pack/network/network_pack.hpp"
#include "baker/research/precision/check_int8.hpp"
#include "tests/pack/pack_editor.hpp"
#include "tests/pack/small_pack.hpp"

using namespace sinew;
using namespace sinew::pack;
using test::PackEditor;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A change that makes a good pack bad, and a word of the message that names it.
struct Damage {
  const char* word;
  std::function<void(PackEditor&)> apply;
};

template <class T>
std::function<void(PackEditor&)> set(SectionKind kind, size_t index, T value) {
  return [=](PackEditor& editor) { editor.section<T>(kind)[index] = value; };
}

std::vector<std::byte> int8_model() {
  baker::PackWriter writer(FileKind::kModel);
  baker::add_network(test::small_paper_weights(), writer, Precision::kInt8, test::small_paper_ranges());
  return writer.finish();
}

// The editor's section, an element longer or shorter.
template <class T>
void add_resized(PackEditor& from, SectionKind kind, int by, baker::PackWriter* writer) {
  const std::span<T> section = from.section<T>(kind);
  std::vector<T> elements(section.begin(), section.end());
  if (by > 0) elements.push_back(T{});
  if (by < 0) elements.pop_back();
  writer->section(kind, elements);
}

// The runtime takes it, whatever the int8 sections hold.
Status status_of(PackEditor editor) {
  PackView view;
  REQUIRE(editor.open(&view).ok());
  return baker::check_int8(view);
}

void check_refused(std::span<const std::byte> good, const std::vector<Damage>& damages) {
  for (const Damage& damage : damages) {
    PackEditor editor(good);
    damage.apply(editor);
    editor.seal();
    const Status status = status_of(std::move(editor));
    INFO("wanted: " << damage.word << ", message: " << status.message);
    CHECK(status.code == StatusCode::kCorrupt);
    CHECK_THAT(status.message, Catch::Contains(damage.word));
  }
}

}  // namespace

TEST_CASE("int8_faults_are_refused_by_name") {
  using enum SectionKind;
  const std::vector<std::byte> model = int8_model();
  REQUIRE(status_of(PackEditor(model)).ok());
  check_refused(model, {{"int8 weights: a number below -127", set<int8_t>(kInt8Weights, 3, int8_t{-128})},
                        {"layer 0: int8 sums", set<int32_t>(kInt8Sums, 7, 1)},
                        {"int8 scales", set<float>(kInt8Scales, 2, -1.0f)},
                        {"int8 scales", set<float>(kInt8Scales, 2, kInfinity)},
                        {"int8 scales", set<float>(kInt8Scales, 2, kNan)}});
}

TEST_CASE("int8_sections_that_are_too_short_or_too_long_are_refused") {
  using enum SectionKind;
  PackEditor good(int8_model());
  for (const SectionKind kind : {kInt8Weights, kInt8Sums, kInt8Scales}) {
    for (const int by : {-1, 1}) {
      baker::PackWriter writer(FileKind::kModel);
      baker::add_network(test::small_paper_weights(), writer);
      add_resized<int8_t>(good, kInt8Weights, kind == kInt8Weights ? by : 0, &writer);
      add_resized<int32_t>(good, kInt8Sums, kind == kInt8Sums ? by : 0, &writer);
      add_resized<float>(good, kInt8Scales, kind == kInt8Scales ? by : 0, &writer);
      const auto is_int8 = [](PackEditor& e) {
        e.section<NetworkRecord>(kNetwork)[0].precision = Precision::kInt8;
      };
      check_refused(writer.finish(), {{"the layers make 1792, 80 and 112", is_int8}});
    }
  }
}
