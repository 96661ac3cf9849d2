// tiny_file.cpp  The bar, and glb bytes.
#include "tiny_file.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace {

void append_u32(std::string& out, size_t value) {
  const auto number = static_cast<uint32_t>(value);
  out.append(reinterpret_cast<const char*>(&number), 4);
}

}  // namespace

std::string write_bytes(const std::string& name, const std::string& bytes) {
  const auto folder = std::filesystem::temp_directory_path() / ("sinew_import_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::string path = (folder / name).string();
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return path;
}

void TinyFile::animate(int node, const std::string& path, const std::string& interpolation,
                       const std::vector<float>& times, const std::vector<float>& values) {
  const int input = add_floats(times, "SCALAR"),
            output = add_floats(values, path == "rotation" ? "VEC4" : "VEC3");
  json["animations"].push_back(
      {{"name", "clip"},
       {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}});
}

std::string TinyFile::glb() const {
  nlohmann::json file = json;
  std::string binary = bytes;
  binary.resize((binary.size() + 3) / 4 * 4);
  if (!file.contains("buffers")) file["buffers"] = {{{"byteLength", binary.size()}}};
  std::string text = file.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string out = "glTF";
  append_u32(out, 2);
  append_u32(out, 28 + text.size() + binary.size());
  append_u32(out, text.size());
  out += "JSON" + text;
  append_u32(out, binary.size());
  return out + std::string("BIN\0", 4) + binary;
}

std::string TinyFile::write(const std::string& name) const { return write_bytes(name + ".glb", glb()); }

TinyFile bar() {
  TinyFile file;
  file.json = {{"asset", {{"version", "2.0"}}},
               {"scene", 0},
               {"scenes", {{{"nodes", {0, 2}}}}},
               {"nodes",
                {{{"name", "lower"}, {"children", {1}}},
                 {{"name", "upper"}, {"translation", {0, 1, 0}}},
                 {{"name", "body"}, {"mesh", 0}, {"skin", 0}}}}};
  const int positions = file.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0}, "VEC3");
  const int joints = file.add<uint8_t>(
      {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4", 5121);
  const int weights = file.add_floats(
      {1, 0, 0, 0, 1, 0, 0, 0, .5f, .5f, 0, 0, .5f, .5f, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4");
  const int indices = file.add<uint16_t>({0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5}, "SCALAR", 5123);
  const int binds = file.add_floats(
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1},
      "MAT4");
  file.json["meshes"] = {
      {{"name", "bar"},
       {"primitives",
        {{{"attributes", {{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
          {"indices", indices}}}}}};
  file.json["skins"] = {{{"joints", {0, 1}}, {"inverseBindMatrices", binds}}};
  return file;
}
