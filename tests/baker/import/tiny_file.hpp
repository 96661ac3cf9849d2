// tiny_file.hpp  Small glTF files made by the tests: a bar of three rungs on two joints, to be changed at
// will.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

struct TinyFile {
  nlohmann::json json;
  std::string bytes;  // of the one buffer

  // Appends values as an accessor of their own bufferView and returns its index.
  template <class T>
  int add(const std::vector<T>& values, const std::string& type, int component_type, bool normalized = false);
  int add_floats(const std::vector<float>& values, const std::string& type) {
    return add(values, type, 5126);
  }

  nlohmann::json& attribute(const std::string& name) {
    return json["meshes"][0]["primitives"][0]["attributes"][name];
  }
  // Appends a clip that moves `node`.
  void animate(int node, const std::string& path, const std::string& interpolation,
               const std::vector<float>& times, const std::vector<float>& values);

  std::string glb() const;                           // the whole file
  std::string write(const std::string& name) const;  // as .glb in a folder of this process; the path
};

// Node 0 and its child 1 are the joints "lower" and "upper", at y = 0 and y = 1; node 2 shows the mesh.
// Vertices 0 1 stand at y = 0, 2 3 at y = 1, 4 5 at y = 2.
TinyFile bar();

std::string write_bytes(const std::string& name, const std::string& bytes);

template <class T>
int TinyFile::add(const std::vector<T>& values, const std::string& type, int component_type,
                  bool normalized) {
  const size_t width = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : static_cast<size_t>(type[3] - '0');
  bytes.resize((bytes.size() + 3) / 4 * 4);
  json["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}});
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                               {"componentType", component_type},
                               {"normalized", normalized},
                               {"count", values.size() / width},
                               {"type", type}});
  return static_cast<int>(json["accessors"].size()) - 1;
}
