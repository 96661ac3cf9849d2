// gltf.cpp  A file is refused with one line, or imported as a character whose numbers are finite and whose
// indices lie in it.
#include <Eigen/Core>
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string>

#include "baker/common/bad_input.hpp"
#include "baker/import/import_gltf.hpp"
#include "tests/fuzz/file_in_memory.hpp"
#include "tests/fuzz/mutate.hpp"

using namespace sinew;

namespace {

constexpr size_t kChunk = 8, kJson = 12 + kChunk;  // bytes of a chunk's header; where a GLB's text begins
constexpr size_t kMostVertices = 20000;            // a larger one takes longer than it teaches

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "of an imported character %s\n", what);
  std::abort();
}

void check(const baker::Character& character) {
  const auto vertices = static_cast<int>(character.positions.size());
  const auto joints = static_cast<int>(character.inverse_bind.size());
  const auto is_finite = [](const auto& value) { return value.allFinite(); };
  require(std::ranges::all_of(character.positions, is_finite), "a position is not finite");
  require(std::ranges::all_of(character.normals, is_finite), "a normal is not finite");
  require(std::ranges::all_of(character.inverse_bind, is_finite), "a bind matrix is not finite");
  require(character.normals.size() == character.positions.size(), "normals and positions differ in number");
  for (const auto& triangle : character.triangles)
    require(std::ranges::all_of(triangle, [&](int v) { return v >= 0 && v < vertices; }),
            "a triangle names a vertex that is not there");
  for (const baker::Influences& skin : character.skin)
    for (size_t k = 0; k < skin.joint.size(); ++k) {
      require(skin.joint[k] >= 0 && skin.joint[k] < joints, "a vertex names a joint that is not there");
      require(skin.weight[k] >= 0 && skin.weight[k] <= 1 + 1e-9, "a weight is out of range");
    }
}

uint32_t u32_at(const uint8_t* at) {
  uint32_t value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

void put_u32(uint8_t* at, size_t value) {
  const auto word = static_cast<uint32_t>(value);
  std::memcpy(at, &word, sizeof word);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FileInMemory file;
  try {
    check(baker::import_gltf(file.write(data, size), {.max_vertices = kMostVertices}));
  } catch (const baker::BadInput& refusal) {
    require(std::strlen(refusal.what()) > 0 && std::strchr(refusal.what(), '\n') == nullptr,
            "the refusal is not one line");
  }
  return 0;
}

// A GLB's text and its numbers are changed each by themselves, and their lengths made right.
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  fuzz::Random random(seed);
  if (size < kJson || std::memcmp(data, "glTF", 4) != 0)
    return fuzz::change_json(data, size, max_size, random);
  const size_t text = u32_at(data + 12);
  if (text > size - kJson || random() % 16 == 0) return LLVMFuzzerMutate(data, size, max_size);
  const std::string rest(data + kJson + text, data + size);
  size_t new_text = text;
  if (random() % 4 != 0 && max_size >= size + 4) {
    new_text = fuzz::change_json(data + kJson, text, max_size - kJson - rest.size() - 3, random);
    for (; new_text % 4 != 0; ++new_text) data[kJson + new_text] = ' ';
    put_u32(data + 12, new_text);
    put_u32(data + 8, kJson + new_text + rest.size());
  }
  std::memcpy(data + kJson + new_text, rest.data(), rest.size());
  if (rest.size() > kChunk && random() % 2 == 0)
    fuzz::change_word({data + kJson + new_text + kChunk, rest.size() - kChunk}, random);
  return kJson + new_text + rest.size();
}
