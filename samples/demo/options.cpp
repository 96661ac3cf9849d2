// options.cpp  see options.hpp.
#include "samples/demo/options.hpp"

#include <CLI/CLI.hpp>
#include <cmath>

#include "baker/common/bad_input.hpp"
#include "baker/common/within.hpp"

namespace sinew::demo {
namespace {

using baker::within;

void add_options(CLI::App& app, Options* o) {
  app.add_option("pack", o->pack, "baked character, .sinew")->required();
  app.add_option("--instances", o->instances, "characters on the floor")
      ->check(within(1, 10000, "1 to 10000"));
  app.add_option("--seconds", o->seconds, "simulated time")->check(within(0.01, 86400, "0.01 to 86400 s"));
  app.add_option("--fps", o->fps, "frames a simulated second")->check(within(1, 1000, "1 to 1000"));
  app.add_option("--budget-us", o->budget_us, "microseconds a step may take; without: no limit")
      ->check(within(1e-3, 1e9, "above 0 us (leave it out for no limit)"));
  app.add_option("--threads", o->threads, "that share a step")->check(within(1, 256, "1 to 256"));
  app.add_flag("--camera", o->camera, "that turns to and fro: what it does not show is not simulated");
  app.add_option("--clip", o->clip, "play only this clip");
  app.add_option("--truth", o->truth, "trajectory to follow and to measure against");
  app.add_option("--report", o->report, "write every frame's times and tiers, .json");
  app.add_option("--trace", o->trace,
                 "write what ran when, .json for Perfetto or chrome://tracing; the last 300 frames");
  app.add_option("--frames", o->frames, "write pictures into this folder");
  app.add_option("--width", o->width, "of a panel, pixels")->check(within(64, 4096, "64 to 4096 pixels"));
  app.add_option("--height", o->height, "of a panel, pixels")->check(within(64, 4096, "64 to 4096 pixels"));
  app.add_option("--samples", o->samples, "rays a pixel")->check(within(1, 4096, "1 to 4096"));
  app.add_option("--picture-fps", o->picture_fps, "pictures a second")->check(within(1, 120, "1 to 120"));
}

constexpr double kMostFrames = 5e6;

}  // namespace

bool parse_options(int argc, char** argv, Options* out) {
  CLI::App app(
      "Runs baked characters in a frame loop without a window; times it, reports it, takes pictures of it.");
  add_options(app, out);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    app.exit(help);
    return false;
  } catch (const CLI::ParseError& error) {
    throw baker::BadInput(std::string(error.what()) + "; see sinew-demo --help");
  }
  if (out->seconds * std::max(out->fps, 60.0) > kMostFrames) {
    throw baker::BadInput("--seconds x --fps: more than 5 million frames; ask for less");
  }
  return true;
}

}  // namespace sinew::demo
