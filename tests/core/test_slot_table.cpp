// test_slot_table.cpp  Ids name objects; a dead object's id never names another.
#include <catch2/catch.hpp>
#include <memory>

#include "core/slot_table.hpp"
#include "sinew/id.hpp"

using sinew::InstanceId;
using Table = sinew::core::SlotTable<std::unique_ptr<int>, InstanceId>;

namespace {

InstanceId put(Table& table, int value) { return table.create(std::make_unique<int>(value)); }

}  // namespace

TEST_CASE("slot_table_refuses_null_foreign_and_stale_ids") {
  Table table;
  REQUIRE(table.reserve(2));
  CHECK(table.find({}) == nullptr);
  CHECK(table.find({3, 1}) == nullptr);
  const InstanceId id = put(table, 7);
  CHECK(table.find({id.index1, id.generation + 1}) == nullptr);
  table.destroy({id.index1, id.generation + 1});
  REQUIRE(table.find(id) != nullptr);
  table.destroy(id);
  CHECK(table.find(id) == nullptr);
  table.destroy(id);
  CHECK(table.count() == 0);
}

TEST_CASE("slot_table_reuses_slots_with_a_new_generation") {
  Table table;
  REQUIRE(table.reserve(2));
  const InstanceId first = put(table, 1);
  table.destroy(first);
  const InstanceId second = put(table, 2);
  CHECK(second.index1 == first.index1);
  CHECK(second.generation == first.generation + 1);
  CHECK(table.find(first) == nullptr);
  CHECK(**table.find(second) == 2);
}

TEST_CASE("slot_table_answers_null_when_full") {
  Table table;
  REQUIRE(table.reserve(2));
  put(table, 1);
  const InstanceId kept = put(table, 2);
  CHECK(is_null(put(table, 3)));
  CHECK(**table.find(kept) == 2);
  CHECK(table.count() == 2);
}

TEST_CASE("slot_table_walks_live_slots") {
  Table table;
  REQUIRE(table.reserve(4));
  const InstanceId a = put(table, 1);
  const InstanceId b = put(table, 2);
  table.destroy(a);
  CHECK(table.end() == 2);
  CHECK(table.at(0) == nullptr);
  CHECK(**table.at(1) == 2);
  CHECK(table.id_at(1) == b);
}
