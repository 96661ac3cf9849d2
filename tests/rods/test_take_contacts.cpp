// test_take_contacts.cpp  A collider that takes another's contact forces goes on as that one does.
#include <string>

#include "tests/rods/contact_scenes.hpp"

using namespace sinew;

namespace {

void check_refused(const rods::RodCollider& from, StatusCode code, const char* expected,
                   rods::RodCollider* to) {
  const Status status = to->take_state(from);
  CHECK(status.code == code);
  CHECK_THAT(status.message, Catch::Contains(expected));
}

// Held at its root, it has fallen onto a floor.
class Lying {
 public:
  explicit Lying(const rods::ColliderSettings& settings = {}, const rods::RodSettings& rods = kRods)
      : batch(test::batch_of({rod(), rod()}, rods)), collider(test::collider_of(batch, settings)) {
    const rods::Plane floor = {.point_m = {0, -0.1, 0}, .friction = 0};
    REQUIRE(collider.set_planes({&floor, 1}).ok());
  }
  void fall(int steps) {
    for (int i = 0; i < steps; ++i) last = test::step(batch, collider);
  }
  // To a step in contact whose forces are kept.
  void touch() {
    for (int i = 0; i < 400 && !(last.contacts > 0 && last.unconverged == 0); ++i) fall(1);
    REQUIRE(last.contacts > 0);
    REQUIRE(last.unconverged == 0);
  }
  static test::Segments rod() {
    return test::straight_rod({.segments = 12, .young_pa = 1e7f, .length_m = 1, .radius_m = 0.01f});
  }
  static constexpr rods::RodSettings kRods = {.max_iterations = 40, .tolerance_rad = 1e-4f};
  // Where contacts' forces go on as they changed as well.
  static constexpr rods::RodSettings kContinued = {
      .start = rods::RodStart::kContinued, .max_iterations = 40, .tolerance_rad = 1e-4f};

  test::RodBatch batch;
  rods::RodCollider collider;
  rods::RodReport last;
};

double apart(const Lying& a, const Lying& b) {
  double largest = 0;
  for (uint32_t s = 0; s < 2; ++s) {
    for (uint32_t i = 0; i < 12; ++i) {
      largest =
          std::max(largest, test::distance(a.batch.pose(s, i).position_m, b.batch.pose(s, i).position_m));
    }
  }
  return largest;
}

}  // namespace

TEST_CASE("contact_forces_are_taken_only_from_a_collider_for_the_same_batch_with_no_more_room") {
  Lying own, roomy({.contact_capacity = 1000}), reference;
  own.fall(40);
  reference.fall(40);
  const test::RodBatch longer = test::batch_of({test::helix(13), test::helix(13)});
  const test::RodBatch fewer = test::batch_of({Lying::rod()});
  check_refused(test::collider_of(longer), StatusCode::kInvalidArgument, "made for the same batch",
                &own.collider);
  check_refused(test::collider_of(fewer), StatusCode::kInvalidArgument,
                "is for 1 strands of 12 segments, this one for 2 of 12", &own.collider);
  check_refused(rods::RodCollider(), StatusCode::kInvalidArgument, "made for the same batch", &own.collider);
  check_refused(roomy.collider, StatusCode::kOutOfCapacity, "room for 1000 contacts, this one for 96",
                &own.collider);
  // Untouched: it goes on as one that was never asked; nor does taking its own change anything.
  REQUIRE(own.collider.take_state(own.collider).ok());
  for (int i = 0; i < 5; ++i) {
    own.fall(1);
    reference.fall(1);
    CHECK(apart(own, reference) == 0);  // the same floats through the same operations
  }
}

TEST_CASE("a_batch_and_a_collider_that_take_anothers_state_take_the_same_steps") {
  const uint32_t capacity = GENERATE(0u, 500u);  // another size of table
  const rods::RodSettings settings = GENERATE(Lying::kRods, Lying::kContinued);
  Lying from({}, settings), to({.contact_capacity = capacity}, settings);
  from.touch();
  from.fall(4);
  to.fall(3);
  REQUIRE(to.batch.take_state(from.batch).ok());
  REQUIRE(to.collider.take_state(from.collider).ok());
  for (int i = 0; i < 10; ++i) {
    from.fall(1);
    to.fall(1);
    CHECK(apart(from, to) == 0);  // the same floats through the same operations
  }
}

TEST_CASE("a_batch_and_a_collider_that_are_restored_take_the_same_steps_again") {
  const rods::RodSettings settings = GENERATE(Lying::kRods, Lying::kContinued);
  Lying lying({}, settings);
  lying.touch();
  lying.fall(4);
  std::vector<std::byte> batch(lying.batch.state_bytes()), forces(lying.collider.state_bytes());
  lying.batch.save_state(batch.data());
  lying.collider.save_state(forces.data());
  std::vector<rods::SegmentPose> first;
  for (const int run : {0, 1}) {
    for (int i = 0; i < 10; ++i) {
      lying.fall(1);
      if (run == 0) first.push_back(lying.batch.pose(0, 11));
      CHECK(test::distance(first[static_cast<size_t>(i)].position_m, lying.batch.pose(0, 11).position_m) ==
            0);
    }
    lying.batch.restore_state(batch.data());
    lying.collider.restore_state(forces.data());
  }
  // The forces matter: without them the same state goes elsewhere.
  Lying fresh({}, settings);
  REQUIRE(fresh.batch.take_state(lying.batch).ok());
  fresh.fall(1);
  CHECK(test::distance(first[0].position_m, fresh.batch.pose(0, 11).position_m) > 0);
  // The same forces have the same bytes.
  std::vector<std::byte> again(lying.collider.state_bytes());
  lying.collider.save_state(again.data());
  lying.collider.restore_state(forces.data());
  lying.collider.save_state(again.data());
  CHECK(again == forces);
}

TEST_CASE("forces_of_its_own_are_forgotten_where_another_has_none") {
  Lying touching, fresh, other;
  touching.fall(40);
  other.touch();
  REQUIRE(fresh.batch.take_state(touching.batch).ok());
  REQUIRE(other.batch.take_state(touching.batch).ok());
  REQUIRE(other.collider.take_state(fresh.collider).ok());
  other.fall(1);
  fresh.fall(1);
  CHECK(apart(other, fresh) == 0);  // both began without contact forces
}
