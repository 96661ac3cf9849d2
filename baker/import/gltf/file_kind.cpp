// file_kind.cpp  First bytes of what artists take for a glTF.
#include "baker/import/gltf/file_kind.hpp"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "pack/format.hpp"

namespace sinew::baker {
namespace {

using std::string_view_literals::operator""sv;

constexpr const char* kExport = "export the character as glTF 2.0 (.glb)";

struct Beginning {
  std::string_view bytes;
  const char* what;
  const char* mend;
};

constexpr Beginning kBeginnings[] = {
    {"Kaydara FBX"sv, "an FBX", kExport},
    {"; FBX"sv, "an FBX", kExport},
    {{pack::kMagic, sizeof pack::kMagic}, "a baked .sinew", "give the glTF or VRM that it was baked from"},
    {"BLENDER"sv, "a Blender file", kExport},
    {"<?xml"sv, "XML, as COLLADA (.dae) is", kExport},
    {"<COLLADA"sv, "COLLADA", kExport},
    {"#usda"sv, "USD", kExport},
    {"PXR-USDC"sv, "USD", kExport},
    {"ply\n"sv, "a PLY", kExport},
    {"solid "sv, "an STL", kExport},
    {"mtllib "sv, "an OBJ", kExport},
    {"PK\x03\x04"sv, "a zip archive", "unpack it and give the .glb or .gltf in it"},
    {"\x89PNG"sv, "a PNG picture", "give the .glb, not its texture"},
    {"\xff\xd8\xff"sv, "a JPEG picture", "give the .glb, not its texture"},
    {"version https://git-lfs"sv, "a pointer of Git LFS", "fetch the file itself: git lfs pull"},
};

bool is_text(const std::vector<unsigned char>& bytes) {
  const auto printable = [](unsigned char c) { return c >= 0x20 || c == '\n' || c == '\r' || c == '\t'; };
  return std::all_of(bytes.begin(), bytes.begin() + std::min<std::ptrdiff_t>(256, std::ssize(bytes)),
                     printable);
}

}  // namespace

FileKind kind_of_file(const std::vector<unsigned char>& bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (const Beginning& known : kBeginnings)
    if (text.starts_with(known.bytes)) return {known.what, known.mend};
  if (text.size() > 8 && text.substr(8, 2) == "{\"") return {"a .safetensors", "give the glTF or VRM itself"};
  if (is_text(bytes)) return {"a text", kExport};
  std::string first = "the bytes";
  for (size_t i = 0; i < std::min<size_t>(4, bytes.size()); ++i) {
    char digits[4];
    std::snprintf(digits, sizeof digits, " %02x", bytes[i]);
    first += digits;
  }
  return {first, "export or copy it again as glTF 2.0 (.glb)"};
}

}  // namespace sinew::baker
