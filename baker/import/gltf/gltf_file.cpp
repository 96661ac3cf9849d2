// gltf_file.cpp  Container checks, then tinygltf.
#include "baker/import/gltf/gltf_file.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/kept_files.hpp"
#include "baker/import/gltf/file_kind.hpp"
#include "baker/import/gltf/meshopt_views.hpp"
#include "baker/import/gltf/required_extensions.hpp"

namespace sinew::baker {
namespace {

namespace fs = std::filesystem;

constexpr uintmax_t kMaxFileBytes = 1u << 30;
constexpr int kMaxJsonDepth = 200;  // tinygltf copies extras by recursion: a deeper file would end the stack
constexpr uint32_t kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

// Only whole regular files: a pipe or a device would block or never end.
bool read_regular_file(const std::string& path, std::vector<unsigned char>* out, std::string* error) {
  std::error_code code;
  if (!fs::exists(path, code)) return *error = "there is no such file", false;
  if (fs::is_directory(path, code)) return *error = "this is a directory, not a file", false;
  if (!fs::is_regular_file(path, code)) return *error = "this is not a file", false;
  const uintmax_t size = fs::file_size(path, code);
  if (code || size > kMaxFileBytes) return *error = "the file is larger than 1 GiB", false;
  out->resize(size);
  std::ifstream stream(path, std::ios::binary);
  stream.read(reinterpret_cast<char*>(out->data()), static_cast<std::streamsize>(size));
  if (!stream) return *error = "the file cannot be read", false;
  return true;
}

uint32_t u32_at(const std::vector<unsigned char>& bytes, size_t offset) {
  uint32_t value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

bool is_glb(const std::vector<unsigned char>& bytes) {
  return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
}

void check_json_depth(const Source& source, const char* json, size_t size) {
  int depth = 0;
  bool in_string = false;
  for (size_t i = 0; i < size; ++i) {
    const char c = json[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kMaxJsonDepth)
        source.refuse("JSON byte " + std::to_string(i), "nested deeper than " + std::to_string(kMaxJsonDepth),
                      "no glTF needs that; export the file again");
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

// tinygltf 2.7 lets the binary chunk reach past the end of the file.
void check_glb(const Source& source, const std::vector<unsigned char>& bytes) {
  const char* mend = "the file is damaged; export or copy it again";
  if (bytes.size() < 20) source.refuse("GLB header", "the file ends inside it", mend);
  if (u32_at(bytes, 4) != 2)
    source.refuse("GLB header", "version " + std::to_string(u32_at(bytes, 4)) + " is not 2",
                  "export as glTF 2.0");
  const size_t length = u32_at(bytes, 8);
  if (length > bytes.size())
    source.refuse(
        "GLB header",
        "promises " + std::to_string(length) + " bytes, the file has " + std::to_string(bytes.size()), mend);
  const size_t json_end = 20 + static_cast<size_t>(u32_at(bytes, 12));
  if (u32_at(bytes, 16) != kJsonChunk || json_end > length)
    source.refuse("GLB chunk 0", "is not a JSON chunk inside the file", mend);
  if (json_end == length) return;
  if (json_end + 8 > length)
    source.refuse("GLB chunk 1", "its header reaches past the end of the file", mend);
  if (u32_at(bytes, json_end + 4) == kBinChunk && json_end + 8 + u32_at(bytes, json_end) > length)
    source.refuse("GLB chunk 1", "reaches past the end of the file", mend);
}

// A binary chunk of no bytes is the same as none; tinygltf refuses it.
void drop_empty_bin_chunk(std::vector<unsigned char>& bytes) {
  const size_t json_end = 20 + static_cast<size_t>(u32_at(bytes, 12));
  if (json_end + 8 > bytes.size() || u32_at(bytes, json_end) != 0) return;
  const auto length = static_cast<uint32_t>(json_end);
  std::memcpy(bytes.data() + 8, &length, sizeof length);
  bytes.resize(json_end);
}

// Images stay encoded: most are never looked at.
bool keep_encoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  image->image.assign(bytes, bytes + size);
  image->as_is = true;
  return true;
}

// tinygltf also looks into the working directory: a file of the same name there must not stand in for a
// missing one.
bool exists_beside(const std::string& path, void* base) {
  std::error_code code;
  return path.starts_with(*static_cast<std::string*>(base)) && fs::is_regular_file(path, code);
}

std::string unexpanded(const std::string& path, void*) { return path; }

bool read_beside(std::vector<unsigned char>* out, std::string* error, const std::string& path, void*) {
  keep_file(path);
  return read_regular_file(path, out, error);
}

std::string base_folder(const std::string& path) {
  std::error_code code;
  const fs::path absolute = fs::absolute(path, code);
  return absolute.parent_path().string();
}

std::string mend_for(const std::string& error) {
  if (error.find("File not found") != std::string::npos || error.find("File read error") != std::string::npos)
    return "put that file next to it, or export as one .glb";
  if (error.find("parse_error") != std::string::npos)
    return "the JSON is damaged; export or copy the file again";
  return "export the file again as glTF 2.0";
}

// A skin need not have inverse bind matrices (glTF 2.0, 3.7.3.1); tinygltf says that they are missing.
void drop_false_faults(std::string& error) {
  constexpr std::string_view kFalse = "'inverseBindMatrices' property is missing";
  for (size_t at = error.find(kFalse); at != std::string::npos; at = error.find(kFalse))
    error.erase(at, std::min(error.find('\n', at), error.size() - 1) + 1 - at);
}

bool load(tinygltf::Model* model, std::vector<unsigned char>& bytes, std::string base, std::string* error,
          std::string* warning) {
  tinygltf::TinyGLTF reader;
  reader.SetImageLoader(keep_encoded, nullptr);
  reader.SetFsCallbacks({exists_beside, unexpanded, read_beside, nullptr, &base});
  const auto size = static_cast<unsigned>(bytes.size());
  if (is_glb(bytes)) return reader.LoadBinaryFromMemory(model, error, warning, bytes.data(), size, base);
  return reader.LoadASCIIFromString(model, error, warning, reinterpret_cast<const char*>(bytes.data()), size,
                                    base);
}

// A .gltf is a JSON object, behind a byte order mark or not.
void check_json_begins(const Source& source, const std::vector<unsigned char>& bytes) {
  constexpr unsigned char kByteOrderMark[] = {0xef, 0xbb, 0xbf};
  auto at = bytes.begin();
  if (bytes.size() >= 3 && std::equal(at, at + 3, kByteOrderMark)) at += 3;
  at = std::find_if_not(at, bytes.end(), [](unsigned char c) { return std::isspace(c); });
  if (at != bytes.end() && *at == '{') return;
  const FileKind kind = kind_of_file(bytes);
  source.refuse("", "not a glTF file: it begins like " + kind.what, kind.mend);
}

void check_container(const Source& source, std::vector<unsigned char>& bytes) {
  if (bytes.empty()) source.refuse("", "the file is empty", "export it again");
  if (!is_glb(bytes)) check_json_begins(source, bytes);
  if (!is_glb(bytes))
    return check_json_depth(source, reinterpret_cast<const char*>(bytes.data()), bytes.size());
  check_glb(source, bytes);
  drop_empty_bin_chunk(bytes);
  check_json_depth(source, reinterpret_cast<const char*>(bytes.data()) + 20, u32_at(bytes, 12));
}

}  // namespace

tinygltf::Model read_gltf_file(Source& source) {
  std::vector<unsigned char> bytes;
  std::string error, warning;
  keep_file(source.path());
  if (!read_regular_file(source.path(), &bytes, &error))
    source.refuse("", error, "give the path of a .glb, .gltf or .vrm");
  check_container(source, bytes);
  give_fallback_buffers_bytes(bytes);

  tinygltf::Model model;
  bool loaded = false;
  try {
    loaded = load(&model, bytes, base_folder(source.path()), &error, &warning);
  } catch (const BadInput&) {  // of a file beside it that is to be written
    throw;
  } catch (const std::exception& exception) {
    error += exception.what();
  }
  drop_false_faults(error);
  if (!loaded && error.find("\"asset\" object not found") != std::string::npos)
    source.refuse("", "not a glTF file: it is JSON of another kind, without \"asset\"",
                  "give the path of a .glb, .gltf or .vrm");
  if (!loaded) source.refuse("", error.empty() ? "this is not glTF" : error, mend_for(error));
  if (!model.skins.empty()) check_required_extensions(model, source);  // else it is refused for that
  decode_meshopt_views(model, source);
  // What tinygltf leaves out without failing, such as a primitive that has no attributes.
  if (!error.empty()) source.note("", "read with faults: " + error);
  return model;
}

}  // namespace sinew::baker
