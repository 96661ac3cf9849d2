// test_short_memory.cpp  Where memory is short, surfaces and occluders are refused, and those that are there
// stay. In an executable of its own: it replaces the allocator.
#include "sinew/occluders.hpp"
#include "tests/embree/surface_scenes.hpp"
#include "tests/pack/short_memory.hpp"

using namespace sinew;
using namespace sinew::test;

namespace {

void require_each_is_refused(const Refusals& refusals, size_t at_least) {
  INFO(refusals.wrong);
  REQUIRE(refusals.wrong.empty());
  CHECK(refusals.count >= at_least);
}

}  // namespace

TEST_CASE("without_memory_a_surface_is_not_added_and_others_are_still_found") {
  const MeshData mesh = ball(0.5, 3), small = box({0.1, 0.1, 0.1});
  const std::vector<uint32_t> groups(mesh.triangles.size() / 3, 1);
  SurfaceDef def = mesh.def();
  def.groups = groups;
  for (const bool and_all_after : {false, true}) {
    SurfaceContacts contacts;
    require_each_is_refused(refuse_each([&] { return SurfaceContacts::create({.max_owners = 4}, &contacts); },
                                        [] { return true; }, {and_all_after}),
                            3);
    SurfaceId first, made;
    REQUIRE(contacts.add_surface(small.def(), &first).ok());
    const auto still_finds = [&] {
      const ContactProbe probe{{{0.12, 0, 0}, {0.12, 0, 0}}, {{0.12, 0, 0}, {0.12, 0, 0}}, 0.03f};
      ContactHit hits[4];
      return contacts.find({&probe, 1}, 1.0f / 60, hits) == 1 && made == SurfaceId();
    };
    REQUIRE(still_finds());
    const auto add = [&] { return contacts.add_surface(def, &made); };
    require_each_is_refused(refuse_each(add, still_finds, {and_all_after}), 10);
    CHECK_FALSE(made == SurfaceId());
  }
}

namespace {

// Without any memory at all Embree 3.13 ends the process as it releases a device, so one allocation at a
// time. It does without some of what it asks for: `works` is then asked whether what was made is there, else
// whether all is as it was.
template <class Work, class Works>
size_t refuse_each_of_embree(const Work& work, const Works& works) {
  for (size_t nth = 1; nth < 1000; ++nth) {
    refuse_allocation(nth);
    const Status status = work();
    const size_t asked = allocations_asked_for();
    INFO("allocation " << nth << ": " << status.message);
    REQUIRE((status.ok() || status.code == StatusCode::kOutOfCapacity));
    REQUIRE(works(status.ok()));
    if (status.ok() && asked < nth) return nth - 1;
  }
  return 0;
}

bool hides(Occluders& occluders, double x_m) { return occluders.is_blocked({x_m, 0, 5}, {x_m, 0, -5}); }

}  // namespace

TEST_CASE("without_memory_an_occluder_is_not_added_and_others_still_hide") {
  const MeshData wall = box({1, 1, 0.1});
  Occluders occluders;
  const size_t of_create = refuse_each_of_embree(
      [&] { return Occluders::create({}, &occluders); },
      [&](bool made) {
        OccluderId id;
        const Status status = occluders.add({.triangles = wall.triangles, .places_m = wall.places}, &id);
        if (!made) return status.code == StatusCode::kInvalidArgument;
        occluders.update();
        const bool there = status.ok() && hides(occluders, 0);
        occluders = Occluders();
        return there;
      });
  REQUIRE(Occluders::create({}, &occluders).ok());
  OccluderId first, made;
  REQUIRE(occluders.add({.triangles = wall.triangles, .places_m = wall.places}, &first).ok());
  const OccluderDef beside{
      .triangles = wall.triangles, .places_m = wall.places, .root = {.position_m = {3, 0, 0}}};
  const size_t of_add = refuse_each_of_embree([&] { return occluders.add(beside, &made); },
                                              [&](bool added) {
                                                occluders.update();
                                                const bool right =
                                                    hides(occluders, 0) && hides(occluders, 3) == added;
                                                if (added) REQUIRE(occluders.remove(made).ok());
                                                return right;
                                              });
  OccluderId last;
  REQUIRE(occluders.add(beside, &last).ok());
  double x_m = 3;
  const size_t of_update = refuse_each_of_embree(
      [&]() -> Status {
        occluders.update();
        return {};
      },
      [&](bool) {
        const bool all = hides(occluders, 0) && hides(occluders, x_m),
                   none = !hides(occluders, 0) && !hides(occluders, x_m);
        occluders.update();
        const bool later = hides(occluders, 0) && hides(occluders, x_m);
        RootTransform root{.position_m = {x_m += 0.01, 0, 0}};  // so that there is something to do
        return (all || none) && later && occluders.move(last, root).ok();
      });
  CHECK(of_create >= 3);
  CHECK(of_add >= 3);
  CHECK(of_update >= 1);
}
