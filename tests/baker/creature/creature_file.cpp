// creature_file.cpp  Reading accessors of a tinygltf model.
#include "creature_file.hpp"

#include <catch2/catch.hpp>
#include <cstring>

namespace sinew::test {
namespace {

double component(const unsigned char* at, int type) {
  const auto as = [at](auto value) {
    std::memcpy(&value, at, sizeof value);
    return value;
  };
  if (type == TINYGLTF_COMPONENT_TYPE_FLOAT) return as(float{});
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return as(uint8_t{});
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return as(uint16_t{});
  return as(uint32_t{});
}

}  // namespace

std::vector<double> CreatureFile::numbers(int index) const {
  const tinygltf::Accessor& accessor = model.accessors.at(static_cast<size_t>(index));
  const tinygltf::BufferView& view = model.bufferViews.at(static_cast<size_t>(accessor.bufferView));
  const size_t size =
      static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType)));
  const size_t width =
      static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type)));
  REQUIRE(view.byteOffset % 4 == 0);
  REQUIRE(view.byteLength == size * width * accessor.count);
  const double scale = accessor.normalized ? 1.0 / 65535 : 1;
  std::vector<double> numbers;
  for (size_t i = 0; i < width * accessor.count; ++i)
    numbers.push_back(
        scale * component(&model.buffers[0].data.at(view.byteOffset + i * size), accessor.componentType));
  return numbers;
}

std::vector<double> CreatureFile::attribute(size_t primitive, const std::string& name) const {
  return numbers(model.meshes.at(0).primitives.at(primitive).attributes.at(name));
}

baker::Surface CreatureFile::surface(size_t primitive) const {
  baker::Surface surface;
  const std::vector<double> positions = attribute(primitive, "POSITION");
  for (size_t i = 0; i < positions.size(); i += 3)
    surface.positions.emplace_back(positions[i], positions[i + 1], positions[i + 2]);
  const std::vector<double> indices = numbers(model.meshes.at(0).primitives.at(primitive).indices);
  for (size_t i = 0; i < indices.size(); i += 3)
    surface.triangles.push_back(
        {static_cast<int>(indices[i]), static_cast<int>(indices[i + 1]), static_cast<int>(indices[i + 2])});
  return surface;
}

CreatureFile parse(const std::vector<std::byte>& bytes) {
  CreatureFile file;
  std::string errors, warnings;
  tinygltf::TinyGLTF reader;
  const bool read = reader.LoadBinaryFromMemory(&file.model, &errors, &warnings,
                                                reinterpret_cast<const unsigned char*>(bytes.data()),
                                                static_cast<unsigned>(bytes.size()));
  file.complaints = errors + warnings + (read ? "" : "not read");
  return file;
}

std::string recipe_path() { return SINEW_SOURCE_DIR "/assets/creature/creature.json"; }

const baker::CreatureRecipe& shipped_recipe() {
  static const baker::CreatureRecipe recipe = baker::read_creature_recipe(recipe_path());
  return recipe;
}

const CreatureFile& default_creature() {
  static const CreatureFile file = parse(baker::make_creature(shipped_recipe()));
  return file;
}

}  // namespace sinew::test
