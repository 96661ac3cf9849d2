// cage_support.cpp  Parts that hang on a corner or an edge are hinged, parts that hang on a face are held.
#include "baker/truth/cage/cage_support.hpp"

#include <catch2/catch.hpp>

#include "tests/baker/truth/bodies.hpp"

using namespace sinew::baker;
using sinew::test::Body;
using sinew::test::box_body;

namespace {

// A cube of eight voxels below the origin, held at its foot, and another one moved by `offset`; nodes in one
// place are one.
struct Cubes {
  Body body = box_body({2, 2, 2}, 0.5);
  size_t lower = body.nodes.size();
  std::vector<bool> constrained;

  explicit Cubes(const Vector3& offset) {
    const Body upper = body;
    std::vector<int> number;
    for (const Vector3& at : upper.nodes) number.push_back(node_at(at + offset));
    for (std::array<int, 4> t : upper.tetrahedra) {
      for (int& node : t) node = number[static_cast<size_t>(node)];
      body.tetrahedra.push_back(t);
    }
    constrained = body.held([](const Vector3& p) { return p.y() == 0; });
  }
  int node_at(const Vector3& place) {
    for (size_t i = 0; i < body.nodes.size(); ++i)
      if (body.nodes[i] == place) return static_cast<int>(i);
    body.nodes.push_back(place);
    return static_cast<int>(body.nodes.size()) - 1;
  }
  // How many nodes of the lower, and of the upper cube alone, are hinged.
  std::array<size_t, 2> hinged() const {
    std::array<size_t, 2> count{};
    const std::vector<bool> flags = hinged_nodes(body.nodes, body.tetrahedra, constrained);
    for (size_t i = 0; i < flags.size(); ++i) count[i < lower ? 0 : 1] += flags[i];
    return count;
  }
};

using Counts = std::array<size_t, 2>;

}  // namespace

TEST_CASE("what_hangs_on_a_face_is_held_and_on_an_edge_or_a_corner_is_hinged") {
  CHECK(Cubes({0, 1, 0}).hinged() == Counts{0, 0});
  CHECK(Cubes({0.5, 1, 0.5}).hinged() == Counts{0, 0});
  CHECK(Cubes({1, 1, 0}).hinged() == Counts{0, 24});  // an edge of three nodes: a hinge
  CHECK(Cubes({1, 1, 1}).hinged() == Counts{0, 26});
}

TEST_CASE("a_part_is_held_by_three_nodes_that_are_not_in_a_line") {
  Cubes cubes({5, 5, 5});
  const auto hold = [&](const Vector3& at) {
    cubes.constrained[static_cast<size_t>(cubes.node_at(at))] = true;
  };
  CHECK(cubes.hinged() == Counts{0, 27});
  hold({5, 5, 5});
  hold({5.5, 5, 5});
  hold({6, 5, 5});
  CHECK(cubes.hinged() == Counts{0, 27});
  hold({5, 5.5, 5});
  CHECK(cubes.hinged() == Counts{0, 0});
}

TEST_CASE("a_cage_all_of_whose_nodes_are_free_is_all_hinged") {
  const Body body = box_body({1, 1, 1}, 1);
  const std::vector<bool> free(body.nodes.size(), false);
  CHECK(hinged_nodes(body.nodes, body.tetrahedra, free) == std::vector<bool>(body.nodes.size(), true));
}
