// base_color_texture.cpp  Base colour textures, seen at the vertices.
#include <stb/stb_image_write.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>

#include "baker/import/import_gltf.hpp"
#include "tiny_file.hpp"

using namespace sinew::baker;

namespace {

using Rgba = std::array<uint8_t, 4>;
constexpr Rgba kRed{255, 0, 0, 255}, kGreen{0, 255, 0, 255}, kBlue{0, 0, 255, 255}, kGrey{128, 128, 128, 255},
    kWhite{255, 255, 255, 255};

std::string png(const std::vector<Rgba>& texels, int width) {
  std::string out;
  const auto append = [](void* to, void* data, int size) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<size_t>(size));
  };
  stbi_write_png_to_func(append, &out, width, static_cast<int>(texels.size()) / width, 4, texels.data(),
                         4 * width);
  return out;
}

// The bar under two by two texels: red green above blue grey; vertices 0 to 5 at these coordinates.
TinyFile textured(const std::vector<float>& coordinates, const std::string& image) {
  TinyFile file = bar();
  file.attribute("TEXCOORD_0") = file.add_floats(coordinates, "VEC2");
  file.add<uint8_t>({image.begin(), image.end()}, "SCALAR", 5121);
  file.json["images"] = {{{"bufferView", file.json["bufferViews"].size() - 1}, {"mimeType", "image/png"}}};
  file.json["textures"] = {{{"source", 0}}};
  file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  return file;
}

const std::vector<float> kCorners = {0.25f, 0.25f, 0.75f, 0.25f, 0.25f,  0.75f,
                                     0.75f, 0.75f, 1.25f, 0.25f, -0.25f, 2.75f};
const std::string kFour = png({kRed, kGreen, kBlue, kGrey}, 2);

std::vector<Rgba> colors_of(const TinyFile& file, const std::string& name) {
  return import_gltf(file.write(name)).colors;
}

bool noted(const Character& character, const std::string& text) {
  return std::ranges::any_of(character.notes,
                             [&](const auto& note) { return note.find(text) != std::string::npos; });
}

}  // namespace

TEST_CASE("textures_that_cannot_be_read_leave_the_material_and_a_note") {
  const Character broken = import_gltf(textured(kCorners, "no picture").write("texture_broken"));
  CHECK(std::ranges::all_of(broken.colors, [](const Rgba& c) { return c == kWhite; }));
  CHECK(noted(broken, "cannot be read"));
  TinyFile cut = textured(kCorners, kFour.substr(0, kFour.size() / 2));
  CHECK(colors_of(cut, "texture_cut").size() == 6);
  TinyFile missing = textured(kCorners, kFour);
  missing.json["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
  CHECK(colors_of(missing, "texture_no_coordinates")[0] == kWhite);
  TinyFile out_of_range = textured(kCorners, kFour);
  out_of_range.json["textures"][0]["source"] = 7;
  CHECK(colors_of(out_of_range, "texture_no_image")[0] == kWhite);
  TinyFile damaged = textured(kCorners, kFour);
  damaged.attribute("TEXCOORD_0") = 99;
  CHECK(noted(import_gltf(damaged.write("texture_bad_accessor")), "flat material colour"));
  TinyFile wild = textured({NAN, 0, INFINITY, 0, 1e30f, -1e30f, 0, 0, 0, 0, 0, 0}, kFour);
  CHECK(colors_of(wild, "texture_wild").size() == 6);
}

TEST_CASE("vertices_have_the_colour_of_their_texel_and_coordinates_repeat") {
  CHECK(colors_of(textured(kCorners, kFour), "texture_four") ==
        std::vector<Rgba>{kRed, kGreen, kBlue, kGrey, kRed, kGrey});
}

TEST_CASE("a_texture_is_multiplied_with_its_material") {
  TinyFile file = textured(kCorners, kFour);
  auto& surface = file.json["materials"][0]["pbrMetallicRoughness"];
  surface["baseColorFactor"] = {0, 1, 1, 1};
  const std::vector<Rgba> colors = colors_of(file, "texture_tinted");
  CHECK(colors[0] == Rgba{0, 0, 0, 255});
  CHECK(colors[1] == kGreen);
  CHECK(colors[3] == Rgba{0, 128, 128, 255});
}
