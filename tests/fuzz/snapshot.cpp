// snapshot.cpp  A snapshot that is taken leaves an instance that moves, is read and can be restored again.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <vector>

#include "tests/fuzz/mutate.hpp"
#include "tests/fuzz/snapshot_scenes.hpp"

using namespace sinew;

namespace {

struct Stage {
  std::vector<scenes::PackBytes> packs = fuzz::snapshot_packs();
  std::vector<fuzz::Actor> actors;

  Stage() {
    for (const scenes::PackBytes& pack : packs) actors.push_back(fuzz::make_actor(pack));
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  constexpr int kSteps = 2;
  static Stage stage;
  const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size));
  for (fuzz::Actor& actor : stage.actors) {
    if (!actor.world.restore_state(actor.instance, bytes).ok()) continue;
    fuzz::move_and_read(actor.world, actor.asset, actor.instance, kSteps);
    if (!actor.world.restore_state(actor.instance, actor.clean).ok()) std::abort();
    if (fuzz::save(actor.world, actor.instance) == actor.clean) continue;
    std::fputs("restored, it is saved with other bytes\n", stderr);
    std::abort();
  }
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  constexpr size_t kHeader_bytes = 40, kScalars_bytes = 2048;
  fuzz::Random random(seed);
  if (size <= kHeader_bytes || random() % 64 == 0) return LLVMFuzzerMutate(data, size, max_size);
  // What stands before the arrays decides most.
  const std::span<uint8_t> payload = std::span(data, size).subspan(kHeader_bytes);
  const std::span<uint8_t> scalars = payload.first(std::min(payload.size(), kScalars_bytes));
  for (auto edits = 1 + random() % 3; edits > 0; --edits)
    fuzz::change_word(random() % 2 == 0 ? scalars : payload, random);
  return size;
}
