// test_read_surface.cpp  The surface as an engine's buffers want it: interleaved, in halves, only what moves;
// and single points of it.
#include <Eigen/Core>
#include <array>
#include <limits>

#include "tests/scenes/half_spaces.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::vector<float> normals(const Stage& stage, Space space = Space::kCharacter) {
  std::vector<float> out(size_t{3} * stage.info.vertex_count);
  REQUIRE(stage.world
              .read_normals(stage.blocks[0],
                            {.space = space, .out = out.data(), .capacity = stage.info.vertex_count})
              .ok());
  return out;
}

AssetArrays arrays_of(const Stage& stage) {
  AssetArrays arrays;
  REQUIRE(stage.world.asset_arrays(stage.asset, &arrays).ok());
  return arrays;
}

Eigen::Vector3f at(const std::vector<float>& values, size_t vertex) {
  return Eigen::Vector3f(&values[3 * vertex]);
}

struct Vertex {
  float position[3], normal[4];
  uint32_t color;
};

}  // namespace

TEST_CASE("read_surface_refuses_what_it_cannot_fill") {
  Stage stage;
  const size_t count = stage.info.vertex_count;
  std::vector<float> out(4 * count, -7);
  const auto code = [&](const SurfaceReadDef& def) {
    return stage.world.read_surface(stage.blocks[0], def).code;
  };
  constexpr StatusCode kInvalid = StatusCode::kInvalidArgument;
  CHECK(code({.capacity = count}) == kInvalid);
  CHECK(code({.capacity = count - 1, .positions = {out.data()}}) == kInvalid);
  CHECK(code({.space = static_cast<Space>(3), .capacity = count, .positions = {out.data()}}) == kInvalid);
  CHECK(code({.capacity = count, .positions = {out.data(), 8}}) == kInvalid);
  CHECK(code({.capacity = count, .positions = {out.data(), 12, VertexFormat::kFloat4}}) == kInvalid);
  CHECK(code({.capacity = count, .positions = {out.data(), 14}}) == kInvalid);
  CHECK(code({.capacity = count, .positions = {out.data(), 0, static_cast<VertexFormat>(3)}}) == kInvalid);
  CHECK(code({.capacity = count, .normals = {reinterpret_cast<char*>(out.data()) + 2}}) == kInvalid);
  CHECK(code({.origin_m = {0, static_cast<double>(kNan), 0}, .capacity = count, .positions = {out.data()}}) ==
        StatusCode::kNotFinite);
  CHECK(std::ranges::all_of(out, [](float v) { return v == -7; }));
  CHECK(code({.moved_only = true, .capacity = stage.info.moved_vertex_count, .positions = {out.data()}}) ==
        StatusCode::kOk);
}

TEST_CASE("one_read_fills_an_interleaved_buffer_with_what_single_reads_give") {
  for (const Space space : {Space::kCharacter, Space::kWorld, Space::kBind}) {
    Stage stage;
    stage.play(scenes::walk, 1.3);
    std::vector<Vertex> buffer(stage.info.vertex_count, Vertex{{}, {}, 0xabcdef01});
    REQUIRE(stage.world
                .read_surface(stage.blocks[0],
                              {.space = space,
                               .capacity = buffer.size(),
                               .positions = {buffer[0].position, sizeof(Vertex)},
                               .normals = {buffer[0].normal, sizeof(Vertex), VertexFormat::kFloat4}})
                .ok());
    const std::vector<float> places = stage.read(0, space), turned = normals(stage, space);
    double worst = 0;
    bool untouched = true;
    for (size_t v = 0; v < buffer.size(); ++v) {
      for (size_t k = 0; k < 3; ++k) {
        worst = std::max(worst, static_cast<double>(std::abs(buffer[v].position[k] - places[3 * v + k])));
        worst = std::max(worst, static_cast<double>(std::abs(buffer[v].normal[k] - turned[3 * v + k])));
      }
      untouched = untouched && buffer[v].color == 0xabcdef01 && buffer[v].normal[3] == 0;
    }
    CHECK(worst < 1e-6);  // of deltas, what adding and taking away the bind place rounds
    CHECK(untouched);
  }
}

TEST_CASE("halves_are_the_floats_rounded_to_nearest") {
  Stage stage;
  stage.play(scenes::walk, 1);
  std::vector<uint16_t> halves(size_t{4} * stage.info.vertex_count);
  REQUIRE(stage.world
              .read_surface(stage.blocks[0], {.capacity = stage.info.vertex_count,
                                              .positions = {halves.data(), 0, VertexFormat::kHalf4}})
              .ok());
  const std::vector<float> places = stage.read();
  bool same = true;
  for (size_t v = 0; v < stage.info.vertex_count; ++v) {
    for (size_t k = 0; k < 3; ++k) same = same && halves[4 * v + k] == Eigen::half(places[3 * v + k]).x;
    same = same && halves[4 * v + 3] == Eigen::half(1.0f).x;
  }
  CHECK(same);
}

TEST_CASE("halves_are_ieee_s") {
  CHECK(Eigen::half(1.0f).x == 0x3c00);
  CHECK(Eigen::half(-2.0f).x == 0xc000);
  CHECK(Eigen::half(1 + 0x1p-11f).x == 0x3c00);  // a tie goes to even
  CHECK(Eigen::half(1 + 3 * 0x1p-11f).x == 0x3c02);
  CHECK(Eigen::half(1e6f).x == 0x7c00);
}

TEST_CASE("what_moves_alone_is_read_as_all_of_it_is") {
  const scenes::PackBytes bytes = scenes::soft_block({.regions = 2, .network = false});
  for (const Space space : {Space::kCharacter, Space::kWorld, Space::kBind}) {
    Stage stage(1, {}, bytes);
    stage.play(scenes::walk, 1.3);
    const AssetArrays arrays = arrays_of(stage);
    REQUIRE(arrays.moved_vertices.size() < stage.info.vertex_count);
    std::vector<float> sparse(3 * arrays.moved_vertices.size()), sparse_normals(sparse.size());
    const size_t capacity = arrays.moved_vertices.size();
    REQUIRE(stage.world
                .read_surface(
                    stage.blocks[0],
                    {.space = space, .moved_only = true, .capacity = capacity, .positions = {sparse.data()}})
                .ok());
    REQUIRE(stage.world
                .read_surface(stage.blocks[0], {.space = space,
                                                .moved_only = true,
                                                .capacity = capacity,
                                                .normals = {sparse_normals.data()}})
                .ok());
    const std::vector<float> all = stage.read(0, space), all_normals = normals(stage, space);
    bool same = true;
    std::vector<bool> moves(stage.info.vertex_count);
    for (size_t i = 0; i < capacity; ++i) {
      const size_t v = arrays.moved_vertices[i];
      moves[v] = true;
      same = same && at(sparse, i) == at(all, v) && at(sparse_normals, i) == at(all_normals, v);
    }
    CHECK(same);
    if (space != Space::kBind) continue;
    bool still = true;
    for (size_t v = 0; v < moves.size(); ++v) still = still && (moves[v] || at(all, v).isZero(0));
    CHECK(still);
  }
}

// What an engine's shader does with them: by the inverse transpose of its blended matrix, then to unit
// length.
TEST_CASE("bind_normals_skinned_are_the_characters") {
  Stage stage;
  stage.play(scenes::walk, 1.3);
  const std::vector<float> bound = normals(stage, Space::kBind), shown = normals(stage);
  const AssetArrays arrays = arrays_of(stage);
  const scenes::BlockPose pose = scenes::walk(stage.time_s);
  double worst_rad = 0, moved_rad = 0;
  for (size_t v = 0; v < stage.info.vertex_count; ++v) {
    const size_t skip = v * arrays.skin_stride_bytes;
    const auto* joints =
        reinterpret_cast<const uint16_t*>(reinterpret_cast<const char*>(arrays.skin_joints) + skip);
    const auto* weights =
        reinterpret_cast<const float*>(reinterpret_cast<const char*>(arrays.skin_weights) + skip);
    Eigen::Matrix3f turn = Eigen::Matrix3f::Zero();
    for (uint32_t k = 0; k < kSkinInfluences; ++k) {
      using Rows = Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>;
      turn += weights[k] * Rows(&pose.joints[joints[k]].m[0][0]).leftCols<3>();  // binds do not turn
    }
    const Eigen::Vector3f skinned = (turn.inverse().transpose() * at(bound, v)).normalized();
    worst_rad = std::max(worst_rad, static_cast<double>((skinned - at(shown, v)).norm()));
    moved_rad = std::max(
        moved_rad, static_cast<double>((at(bound, v) - Eigen::Vector3f(&arrays.normals[3 * v])).norm()));
  }
  CHECK(moved_rad > 0.02);
  // The least turn from the bound face to the displaced one is another in sheared space, between two joints:
  // less than half of what displacement turns there, where leaving it out is all of it.
  CHECK(worst_rad < 0.5 * moved_rad);
}

TEST_CASE("tangents_are_unit_square_to_the_normals_and_keep_their_hand") {
  const scenes::PackBytes bytes = scenes::soft_block({.network = false, .tangents = true});
  for (const Space space : {Space::kCharacter, Space::kWorld, Space::kBind}) {
    Stage stage(1, {}, bytes);
    stage.play(scenes::walk, 1.3);
    const AssetArrays arrays = arrays_of(stage);
    const std::vector<float> turned = normals(stage, space);
    std::vector<float> tangents(size_t{4} * stage.info.vertex_count);
    REQUIRE(stage.world
                .read_surface(stage.blocks[0], {.space = space,
                                                .capacity = stage.info.vertex_count,
                                                .tangents = {tangents.data(), 0, VertexFormat::kFloat4}})
                .ok());
    double worst = 0, moved = 0;
    bool same_hand = true;
    for (size_t v = 0; v < stage.info.vertex_count; ++v) {
      const Eigen::Vector3f tangent(&tangents[4 * v]), bound(&arrays.tangents[4 * v]);
      worst = std::max<double>({worst, std::abs(tangent.norm() - 1), std::abs(tangent.dot(at(turned, v)))});
      moved = std::max<double>(moved, (tangent - bound).norm());
      same_hand = same_hand && tangents[4 * v + 3] == arrays.tangents[4 * v + 3];
    }
    CHECK(worst < 1e-5);
    CHECK(moved > 0.02);
    CHECK(same_hand);
  }
}

TEST_CASE("tangents_of_an_asset_without_are_refused") {
  Stage stage;
  std::vector<float> out(size_t{3} * stage.info.vertex_count);
  const Status status = stage.world.read_surface(
      stage.blocks[0], {.capacity = stage.info.vertex_count, .tangents = {out.data()}});
  CHECK(status.code == StatusCode::kInvalidArgument);
  CHECK_THAT(status.message, Catch::Contains("texture coordinates"));
}

// ---- single points ----

TEST_CASE("read_points_refuses_places_that_are_none") {
  Stage stage;
  stage.play(scenes::walk, 0.2);
  std::array<Matrix34, 1> out{};
  const auto code = [&](const SurfacePlace& place, const PointsDef& def = {}) {
    return stage.world.read_points(stage.blocks[0], def, std::span(&place, 1), out).code;
  };
  CHECK(code({.triangle = stage.info.triangle_count}) == StatusCode::kInvalidArgument);
  CHECK(code({.weights = {1, 1, 0}}) == StatusCode::kInvalidArgument);
  CHECK(code({.weights = {1, kNan, 0}}) == StatusCode::kNotFinite);
  CHECK(code({}, {.space = Space::kBind}) == StatusCode::kInvalidArgument);
  CHECK(stage.world.read_points(stage.blocks[0], {}, {}, out).code == StatusCode::kInvalidArgument);
  CHECK(out[0].m[0][0] == 0);
  CHECK(code({}) == StatusCode::kOk);
}

TEST_CASE("points_lie_on_the_surface_that_is_read_and_stand_square_on_it") {
  const scenes::PackBytes bytes = scenes::soft_block({.regions = 2, .network = false});
  for (const Space space : {Space::kCharacter, Space::kWorld}) {
    Stage stage(1, {}, bytes);
    stage.play(scenes::walk, 1.3);
    const AssetArrays arrays = arrays_of(stage);
    const std::vector<float> surface = stage.read(0, space);
    std::vector<SurfacePlace> places;
    for (uint32_t t = 0; t < stage.info.triangle_count; ++t) places.push_back({t, {0.2f, 0.3f, 0.5f}});
    std::vector<Matrix34> frames(places.size());
    REQUIRE(stage.world.read_points(stage.blocks[0], {.space = space}, places, frames).ok());
    double worst_m = 0, worst = 0;
    for (size_t t = 0; t < frames.size(); ++t) {
      const Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>> frame(&frames[t].m[0][0]);
      const Eigen::Vector3f a = at(surface, arrays.triangles[3 * t]),
                            b = at(surface, arrays.triangles[3 * t + 1]),
                            c = at(surface, arrays.triangles[3 * t + 2]);
      worst_m = std::max<double>(worst_m, (frame.col(3) - (0.2f * a + 0.3f * b + 0.5f * c)).norm());
      worst = std::max<double>(worst, (frame.col(2) - (b - a).cross(c - a).normalized()).norm());
      worst = std::max<double>(worst, (frame.col(0) - (b - a).normalized()).norm());
      worst = std::max<double>(worst, std::abs(frame.leftCols<3>().determinant() - 1));
    }
    CHECK(worst_m < 2e-6);  // float places below 1 m; the root's some ten metres away
    CHECK(worst < 2e-4);    // of edges some centimetres long
  }
}

TEST_CASE("bounds_hold_all_that_is_shown") {
  Stage stage(1, {}, test::tailed_pack());
  for (int frame = 0; frame < 40; ++frame) {
    scenes::BlockPose pose = scenes::shake(0.05 * frame);
    const scenes::TailedPose tailed = scenes::with_rods(pose);
    REQUIRE(stage.world.set_pose(stage.blocks[0], tailed.pose()).ok());
    stage.world.step(1.0f / 60);
    Bounds bounds;
    REQUIRE(stage.world.bounds(stage.blocks[0], &bounds).ok());
    const std::vector<float> places = stage.read(0, Space::kWorld);
    double farthest_m = 0;
    for (size_t v = 0; v < stage.info.vertex_count; ++v)
      farthest_m =
          std::max(farthest_m, (at(places, v).cast<double>() - Eigen::Vector3d(bounds.center_m)).norm());
    CHECK(farthest_m <= static_cast<double>(bounds.radius_m));
  }
  CHECK(stage.world.bounds(stage.blocks[0], nullptr).code == StatusCode::kInvalidArgument);
}

TEST_CASE("debug_lines_show_what_flesh_touched_in_the_last_tick") {
  scenes::HalfSpaces ceiling;
  ceiling.walls.push_back({.point_m = {0, 0.55, 0}, .normal = {0, -1, 0}});
  Stage stage(0);
  InstanceId touching;
  REQUIRE(
      stage.world.create_instance({.asset = stage.asset, .contacts = {.source = &ceiling}}, &touching).ok());
  const double origin[3] = {0, 0, 0};
  for (int frame = 0; frame < 10; ++frame) {
    stage.pose(touching, scenes::bind_pose());
    stage.world.step(1.0f / 60);
  }
  std::vector<DebugLine> lines(stage.world.debug_lines(touching, kDebugTouches, origin, {}));
  REQUIRE(!lines.empty());
  stage.world.debug_lines(touching, kDebugTouches, origin, lines);
  for (const DebugLine& line : lines) CHECK(line.to_m[1] < line.from_m[1]);  // out of the ceiling
}

TEST_CASE("debug_lines_are_counted_and_cut_to_the_room_that_there_is") {
  Stage stage(1, {}, test::tailed_pack());
  for (int frame = 0; frame < 20; ++frame) {
    const scenes::TailedPose pose = scenes::with_rods(scenes::shake(0.05 * frame));
    REQUIRE(stage.world.set_pose(stage.blocks[0], pose.pose()).ok());
    stage.world.step(1.0f / 60);
  }
  const double origin[3] = {0, 0, 0};
  const size_t all = stage.world.debug_lines(stage.blocks[0], kDebugAll, origin, {});
  const size_t rods = stage.world.debug_lines(stage.blocks[0], kDebugRods, origin, {});
  CHECK(rods > 3);
  CHECK(all > rods + stage.info.node_count - 1);
  std::vector<DebugLine> lines(all + 1, DebugLine{{kNan}, {}, 7});
  CHECK(stage.world.debug_lines(stage.blocks[0], kDebugAll, origin, std::span(lines).first(2)) == all);
  CHECK(std::isnan(lines[2].from_m[0]));
  CHECK(stage.world.debug_lines(stage.blocks[0], kDebugAll, origin, lines) == all);
  CHECK(lines[all].rgba == 7);
  for (size_t i = 0; i < all; ++i)
    for (int k = 0; k < 3; ++k) CHECK((std::abs(lines[i].from_m[k]) < 5 && std::abs(lines[i].to_m[k]) < 5));
  CHECK(stage.world.debug_lines({}, kDebugAll, origin, lines) == 0);
}
