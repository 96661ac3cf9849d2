// main.cpp  sinew-portrait: pictures of a character file, as the importer sees it.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "baker/common/command_line/program.hpp"
#include "baker/import/import_gltf.hpp"
#include "baker/render/picture/encode.hpp"
#include "samples/portrait/views.hpp"

namespace {

using namespace sinew;

struct Request {
  std::string input, output, clip;
  double time_s = 0;
  bool stiffness = false, turntable = false, clips = false;
  portrait::PictureSize size;
};

constexpr int kColumnsOfClips = 6, kTurnsInSheet = 8, kTurnsInFilm = 72;
constexpr double kFilmFps = 24;

bool is_film(const std::string& path) { return path.ends_with(".mp4") || path.ends_with(".gif"); }

int write_film(const std::vector<render::Cell>& cells, const std::string& path) {
  const std::filesystem::path folder = path + ".frames";
  std::filesystem::create_directories(folder);
  std::vector<std::filesystem::path> frames;
  for (size_t i = 0; i < cells.size(); ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "frame_%04zu.png", i);
    frames.push_back(folder / name);
    render::write_png(frames.back(), cells[i].image);
  }
  const std::string trouble =
      render::encode({.pattern = folder / "frame_%04d.png", .fps = kFilmFps, .path = path});
  if (trouble.empty()) {
    for (const std::filesystem::path& frame : frames) std::filesystem::remove(frame);
    std::error_code in_use;  // something else is in it
    std::filesystem::remove(folder, in_use);
  }
  if (!trouble.empty()) std::fprintf(stderr, "sinew-portrait: %s\n", trouble.c_str());
  return 0;
}

int run(const Request& request) {
  const baker::Character character = baker::import_gltf(request.input);
  const portrait::Paint paint = request.stiffness ? portrait::Paint::kStiffness : portrait::Paint::kColors;
  const portrait::Pose pose{request.clip.empty() ? nullptr : &portrait::find_clip(character, request.clip),
                            request.time_s, paint};
  const bool film = is_film(request.output);
  if (film && !request.turntable)
    throw baker::BadInput(request.output + ": a film needs --turntable; pictures end in .png");
  if (request.turntable) {
    const auto cells =
        portrait::turntable(character, pose, film ? kTurnsInFilm : kTurnsInSheet, request.size);
    if (film) return write_film(cells, request.output);
    render::write_png(request.output, render::contact_sheet(cells, 4, character.name));
  } else if (request.clips) {
    if (character.clips.empty()) throw baker::BadInput(request.input + ": has no clips; leave --clips out");
    const auto cells = portrait::through_clips(character, paint, kColumnsOfClips, request.size);
    render::write_png(request.output, render::contact_sheet(cells, kColumnsOfClips, character.name));
  } else {
    render::write_png(request.output, render::contact_sheet(portrait::sides(character, pose, request.size), 2,
                                                            character.name));
  }
  std::printf("%s\n", request.output.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  CLI::App app("Pictures of a skinned glTF character from several sides.");
  app.add_option("input", request.input, "character, .glb .gltf .vrm")->required();
  baker::add_output(app, "-o,--output", request.output, "picture, .png; with --turntable also .mp4 or .gif")
      ->required();
  app.add_option("--clip", request.clip, "pose from this clip; without: the rest pose");
  app.add_option("--time", request.time_s, "time in the clip, s");
  app.add_flag("--stiffness", request.stiffness, "colour by painted stiffness");
  app.add_flag("--turntable", request.turntable, "a full turn");
  app.add_flag("--clips", request.clips, "every clip at even times, a row each");
  app.add_option("--width", request.size.width, "of each picture, pixels")->check(CLI::Range(16, 8192));
  app.add_option("--height", request.size.height, "of each picture, pixels")->check(CLI::Range(16, 8192));
  app.add_option("--samples", request.size.samples, "a pixel")->check(CLI::Range(1, 4096));
  app.add_option("--threads", request.size.threads, "0: all")->check(CLI::Range(0, 256));
  return baker::run_program("sinew-portrait", app, argc, argv, [&] { return run(request); });
}
