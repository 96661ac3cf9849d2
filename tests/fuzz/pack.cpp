// pack.cpp  A pack that loads makes an instance that moves and is read, and every number is finite.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>

#include "core/aligned_block.hpp"
#include "pack/format.hpp"
#include "tests/fuzz/in_motion.hpp"
#include "tests/fuzz/mutate.hpp"

using namespace sinew;

namespace {

// The section table as far as it lies in the bytes.
std::span<uint8_t> some_section(std::span<uint8_t> bytes, fuzz::Random& random) {
  pack::FileHeader header;
  std::memcpy(&header, bytes.data(), sizeof header);
  const size_t most = (bytes.size() - sizeof header) / sizeof(pack::SectionEntry);
  const size_t count = std::min<size_t>(header.section_count, most);
  if (count == 0) return bytes;
  pack::SectionEntry entry;
  std::memcpy(&entry, bytes.data() + sizeof header + random() % count * sizeof entry, sizeof entry);
  if (entry.offset >= bytes.size()) return bytes;
  const uint64_t left = bytes.size() - entry.offset;
  if (entry.element_bytes == 0 || entry.count > left / entry.element_bytes) return bytes;
  return bytes.subspan(entry.offset, entry.count * entry.element_bytes);
}

// With SINEW_FUZZ_LET_PASS in the environment such packs are counted, and others looked for.
void count_not_finite() {
  static size_t count = 0;
  if (std::getenv("SINEW_FUZZ_LET_PASS") == nullptr) {
    std::fputs("what is read of an instance is not finite\n", stderr);
    std::abort();
  }
  if (count++ == 0) std::atexit([] { std::fprintf(stderr, "not finite: %zu\n", count); });
}

void move_instance(World& world, AssetId asset) {
  constexpr int kSteps = 3;
  InstanceId instance;
  if (!fuzz::add_instance(world, asset, &instance)) return;
  const bool finite = fuzz::move_and_read(world, asset, instance, kSteps);
  (void)world.destroy_instance(instance);
  if (!finite) count_not_finite();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static World world = fuzz::make_world(1, 1);
  const core::AlignedBlock block(size);
  if (size > 0) std::memcpy(block.data(), data, size);
  AssetId asset;
  if (!world.load_asset({block.data(), size}, &asset).ok()) return 0;
  move_instance(world, asset);
  if (!world.unload_asset(asset).ok()) std::abort();
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  fuzz::Random random(seed);
  if (size < sizeof(pack::FileHeader) || random() % 32 == 0) return LLVMFuzzerMutate(data, size, max_size);
  const std::span<uint8_t> bytes(data, size);
  for (auto edits = 1 + random() % 3; edits > 0; --edits)
    fuzz::change_word(random() % 32 == 0 ? bytes : some_section(bytes, random), random);
  return size;
}
