// test_rod_source.cpp  The source and the surface share the room for hits.
#include "character/rods/rod_source.hpp"

#include <catch2/catch.hpp>
#include <vector>

using namespace sinew;

namespace {

constexpr uint32_t kBody = 3;

// Tells of so many hits: the deepest first, each a millimetre deeper than the next.
struct Heap final : ContactSource {
  uint32_t count;
  explicit Heap(uint32_t hits) : count(hits) {}
  uint32_t find(std::span<const ContactProbe>, float, std::span<ContactHit> hits) noexcept override {
    for (uint32_t i = 0; i < std::min<size_t>(count, hits.size()); ++i)
      hits[i] = {.gap_m = -1e-3 * (count - i), .name = i, .body = kBody};
    return count;
  }
};

struct Found {
  uint32_t told = 0, of_source = 0, of_surface = 0;
};

Found ask(uint32_t in_source, uint32_t in_surface, size_t room) {
  Heap source(in_source), surface(in_surface);
  world::RodSource both(&source, &surface);
  std::vector<ContactHit> hits(room);
  const ContactProbe probe;
  Found found{.told = both.find({&probe, 1}, 0.01f, hits)};
  for (const ContactHit& hit : std::span(hits).first(std::min<size_t>(found.told, room)))
    ++(hit.body == kBody ? found.of_source : found.of_surface);
  return found;
}

}  // namespace

TEST_CASE("neither_the_source_nor_the_surface_crowds_out_the_other") {
  struct Case {
    uint32_t in_source, in_surface;
    size_t room;
    uint32_t of_source, of_surface;
  };
  for (const Case& c : {Case{0, 0, 8, 0, 0},
                        {3, 4, 8, 3, 4},
                        {100, 3, 8, 5, 3},
                        {100, 100, 8, 4, 4},
                        {2, 100, 8, 2, 6},
                        {5, 0, 8, 5, 0},
                        {100, 100, 1, 1, 0},
                        {1, 1, 0, 0, 0}}) {
    const Found found = ask(c.in_source, c.in_surface, c.room);
    INFO(c.in_source << " and " << c.in_surface << " in " << c.room);
    CHECK(found.told == c.in_source + c.in_surface);
    CHECK(found.of_source == c.of_source);
    CHECK(found.of_surface == c.of_surface);
  }
}

TEST_CASE("a_surface_alone_has_all_of_the_room") {
  Heap surface(100);
  world::RodSource alone(nullptr, &surface);
  std::vector<ContactHit> hits(8);
  const ContactProbe probe;
  CHECK(alone.find({&probe, 1}, 0.01f, hits) == 100);
  CHECK(hits[7].gap_m == Approx(-0.093));
}
