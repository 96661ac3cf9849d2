// audit.cpp  A character that tears is found out, one that only swings is not.
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "baker/audit/bounds.hpp"
#include "baker/audit/limit_factor.hpp"
#include "baker/audit/parts.hpp"
#include "baker/common/bad_input.hpp"
#include "baker/common/files/write_file.hpp"
#include "baker/measure/loaded_pack.hpp"
#include "baker/pack/character/character_pack.hpp"
#include "tests/baker/common/temporary_folder.hpp"
#include "tests/baker/programs/bake.hpp"
#include "tests/pack/small_pack.hpp"

using namespace sinew;
using namespace sinew::test;

namespace {

// The small character, whose flesh answers so many times as much.
std::vector<std::byte> character_of(double answer) {
  const baker::Character character = small_character();
  baker::TissueLayout layout = small_layout(character);
  for (baker::Region& region : layout.regions) region.max_displacement = 4;
  std::vector<baker::ModalBasis> modes = small_modes(layout);
  for (baker::ModalBasis& basis : modes) basis.force *= answer, basis.rest *= answer;
  return baker::pack_character(character, layout, modes);
}

constexpr double kTears = 30, kSwings = 1e-3;

std::vector<std::string> warnings_on(const std::vector<std::byte>& bytes) {
  const baker::LoadedPack pack = baker::LoadedPack::from_bytes(bytes, "test");
  return baker::quick_audit({pack.view(), pack.bytes()}).failures;
}

}  // namespace

TEST_CASE("an_edge_that_a_pose_presses_together_is_stretched_beyond_its_bind_length_alone") {
  const baker::AuditedParts::Edge edge{0, 1, 0, 1.0};
  CHECK(edge.stretch(0.4, 1.0) == 1);  // flesh gives back what the pose took
  CHECK(edge.stretch(1.2, 1.8) == Approx(1.5));
}

TEST_CASE("a_part_beyond_a_bound_is_to_move_less_and_one_within_all_as_much") {
  baker::PartAudit part;
  part.part.triangles = 1000;
  part.edge_stretch.value = 1.49;
  part.inverted_share.value = 0.009;
  part.bob_m = 0.079;
  CHECK(baker::limit_factor(part, 1) == 1);
  part.edge_stretch.value = 2;
  CHECK(baker::limit_factor(part, 1) == Approx(0.85 * 0.5));
  part.bob_m = 0.32;
  CHECK(baker::limit_factor(part, 1) == Approx(0.85 * 0.25));
  CHECK(baker::limit_factor(part, 10) == Approx(0.85 * 0.5));
  part.part.is_rod = true;  // its bone may swing, and its skin stretch twofold
  CHECK(baker::limit_factor(part, 1) == 1);
  part.edge_stretch.value = std::numeric_limits<double>::infinity();
  CHECK(baker::limit_factor(part, 1) == 0.2);
  baker::PartAudit turned;
  turned.part.triangles = 1000;
  turned.inverted_share.value = 0.02;
  CHECK(baker::limit_factor(turned, 1) < 1);
}

TEST_CASE("audit_refuses_what_is_no_baked_character") {
  const TemporaryFolder folder;
  const std::string missing = folder.file("missing.sinew"), model = folder.file("m.sinew"),
                    damaged = folder.file("d.sinew"), text = folder.file("t.sinew");
  std::vector<std::byte> bytes = character_of(kSwings);
  baker::write_file(model, small_model());
  bytes[bytes.size() / 2] ^= std::byte{1};
  baker::write_file(damaged, bytes);
  baker::write_file(text, std::string_view("hello"));
  check_refused({"audit"}, {"character is required"});
  check_refused({"audit", missing}, {missing, "No such file"});
  check_refused({"audit", folder.path()}, {folder.path()});
  check_refused({"audit", model}, {model, "without a character", "sinew-bake character"});
  check_refused({"audit", damaged}, {damaged});
  check_refused({"audit", text}, {text});
  check_refused({"audit", model, "--xml"}, {"--xml"});
  check_refused({"audit", model, "-o", folder.path()}, {folder.path(), "directory"});
  CHECK_THROWS_AS(warnings_on(small_model()), baker::BadInput);
}

TEST_CASE("a_character_that_tears_fails_with_exit_code_1") {
  const TemporaryFolder folder;
  const std::string path = folder.file("c.sinew");
  baker::write_file(path, character_of(kTears));
  const std::string sheet = folder.file("sheet.png");
  const ProgramResult table = bake({"audit", path}), json = bake({"audit", path, "--json", "-o", sheet});
  CHECK(std::filesystem::file_size(sheet) > 10'000);
  CHECK(table.exit_code == 1);
  CHECK(json.exit_code == 1);
  CHECK_THAT(table.out, Catch::Contains("FAILED: 'belly': an edge is stretched by"));
  CHECK_THAT(table.out, Catch::Contains("not measured"));
  const auto told = nlohmann::json::parse(json.out);
  CHECK(told["ok"] == false);
  CHECK(told["failures"].size() >= 1);
  CHECK(told["parts"][0]["edge_stretch"]["value"] > baker::kMostEdgeStretch);
  CHECK_FALSE(warnings_on(character_of(kTears)).empty());
}

TEST_CASE("a_character_that_only_swings_passes") {
  const TemporaryFolder folder;
  const std::string path = folder.file("c.sinew");
  baker::write_file(path, character_of(kSwings));
  const ProgramResult table = bake({"audit", path}), json = bake({"audit", path, "--json"});
  INFO(table.out << table.error);
  CHECK(table.exit_code == 0);
  CHECK_THAT(table.out, Catch::Contains("within all bounds"));
  const auto told = nlohmann::json::parse(json.out);
  CHECK(told["ok"] == true);
  for (const auto& part : told["parts"]) {
    CHECK(part["displacement_of_height"]["value"] > 0);  // it was played
    CHECK(part["edge_stretch"]["value"] < 1.1);
    CHECK(part["residual_of_height"] < baker::kMostResidual);
    CHECK(part["first_hz"] == Approx(20 / 6.283185).epsilon(1e-4));
  }
  CHECK(warnings_on(character_of(kSwings)).empty());
}

TEST_CASE("vertices_that_visibly_move_are_counted_by_part_and_over_the_character") {
  const TemporaryFolder folder;
  const std::string path = folder.file("c.sinew");
  const auto told_of = [&](double answer) {
    baker::write_file(path, character_of(answer));
    return nlohmann::json::parse(bake({"audit", path, "--json"}).out);
  };
  const nlohmann::json still = told_of(0), moving = told_of(kTears);
  CHECK(still["moving_share"] == 0);
  // Four of twelve vertices are each part's; the ring at the root is nobody's.
  for (const auto& part : moving["parts"]) CHECK(part["moving_share"].get<double>() == Approx(4.0 / 12));
  CHECK(moving["moving_share"].get<double>() == Approx(8.0 / 12));
}

TEST_CASE("rods_are_audited_beside_regions_and_alone") {
  const bool alone = GENERATE(false, true);
  const baker::Character character = small_character();
  baker::TissueLayout layout = small_layout(character);
  layout.rods = small_rods();
  if (alone) layout.regions.clear(), layout.nodes.clear(), layout.edges.clear();
  const std::vector<std::byte> bytes = baker::pack_character(
      character, layout, alone ? std::vector<baker::ModalBasis>{} : small_modes(layout));
  const baker::LoadedPack pack = baker::LoadedPack::from_bytes(bytes, "test");
  const baker::AuditedParts parts = baker::find_parts(pack.view());
  for (size_t v = 0; v < parts.of_vertex.size(); ++v) {
    REQUIRE(parts.of_vertex[v] < static_cast<int>(parts.all.size()));
    // Every segment of the rod, the last of which is not its first, carries its joint's vertices.
    if (alone) CHECK((parts.of_vertex[v] == 0) == (pack.view().skin[v].joint[0] > 0));
  }
  const baker::Audit audit = baker::run_audit({pack.view(), pack.bytes()}, [](size_t, size_t) {});
  REQUIRE(audit.parts.size() == (alone ? 1 : 3));
  const baker::PartAudit& rod = audit.parts.back();
  CHECK(rod.part.is_rod);
  CHECK(rod.part.name == "top");
  CHECK(rod.part.size_m == Approx(0.5));
  CHECK((rod.part.triangles > 0) == alone);
  CHECK(rod.displacement_m.value > 0);
  CHECK(rod.residual_m < baker::kMostResidual * audit.height_m);
}
