// options.cpp  see options.hpp.
#include "samples/demo/options.hpp"

#include <CLI/CLI.hpp>
#include <cmath>

#include "baker/common/bad_input.hpp"
#include "baker/common/command_line/input_files.hpp"
#include "baker/common/command_line/within.hpp"

namespace sinew::demo {
namespace {

using baker::within;

void add_options(CLI::App& app, Options* o) {
  app.add_option("pack", o->pack, "baked character, .sinew")->required();
  app.add_option("--compare", o->compare,
                 "another pack of the same character: both play the same motion side by side");
  app.add_option("--clip", o->clip, "play only this clip; without: all clips in turn, or a shake");
  app.add_option("--seconds", o->seconds, "simulated time; without: 4 s, or the truth's length")
      ->check(within(0.01, 86400, "0.01 to 86400 s"));
  app.add_option("--fps", o->fps, "frames a simulated second; without: 60, or the truth's rate")
      ->check(within(1, 1000, "1 to 1000"));
  app.add_flag_callback(
      "--no-contacts", [o] { o->contacts = false; },
      "leave out contacts with the character's body colliders");
  app.add_option(
         "--start", o->start,
         "what rods' iterations start from: baked (as the recipe says), continued or learned; prints the "
         "residual, too")
      ->check(CLI::IsMember({"baked", "continued", "learned"}));
  app.add_option("--truth", o->truth, "trajectory to follow and to measure against");
}

void add_crowd_options(CLI::App& app, Options* o) {
  app.add_option("--instances", o->instances, "characters on the floor")
      ->check(within(1, 10000, "1 to 10000"))
      ->capture_default_str();
  app.add_option("--budget-us", o->budget_us, "microseconds a step may take; without: no limit")
      ->check(within(1e-3, 1e9, "above 0 us (leave it out for no limit)"));
  app.add_option("--threads", o->threads, "that share a step")
      ->check(within(1, 256, "1 to 256"))
      ->capture_default_str();
  app.add_flag("--camera", o->camera, "one that turns to and fro: what it does not show is not simulated");
}

void add_output_options(CLI::App& app, Options* o) {
  baker::add_output(app, "--report", o->report, "write every frame's times and tiers, .json");
  baker::add_output(app, "--trace", o->trace,
                    "write what ran when, .json for Perfetto or chrome://tracing; the last 300 frames");
  baker::add_output(app, "--frames", o->frames,
                    "write pictures into this folder: contact_sheet.png, still.png");
  app.add_option("--view", o->view, "side that pictures show: front, side, back; auto: where most moves")
      ->check(CLI::IsMember({"auto", "front", "side", "back"}))
      ->capture_default_str();
  app.add_option("--picture-fps", o->picture_fps, "make a film too, of so many pictures a second")
      ->check(within(1, 120, "1 to 120"));
  app.add_option("--width", o->width, "of a panel, pixels")
      ->check(within(64, 4096, "64 to 4096 pixels"))
      ->capture_default_str();
  app.add_option("--height", o->height, "of a panel, pixels")
      ->check(within(64, 4096, "64 to 4096 pixels"))
      ->capture_default_str();
  app.add_option("--samples", o->samples, "rays a pixel")
      ->check(within(1, 4096, "1 to 4096"))
      ->capture_default_str();
}

constexpr double kMostFrames = 5e6;

}  // namespace

bool parse_options(int argc, char** argv, Options* out) {
  CLI::App app(
      "Plays a baked character in a frame loop without a window: prints what each soft part and rod does and "
      "what a step costs, and takes pictures.\n"
      "  sinew-demo C.sinew --frames out                       pictures in seconds\n"
      "  sinew-demo C.sinew --compare B.sinew --frames out     two bakes of one character\n"
      "  sinew-demo C.sinew --frames out --picture-fps 30 --width 360 --height 400 --samples 8   a film");
  add_options(app, out);
  add_crowd_options(app, out);
  add_output_options(app, out);
  baker::keep_inputs(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    app.exit(help);
    return false;
  } catch (const CLI::ParseError& error) {
    throw baker::BadInput(std::string(error.what()) + "; see sinew-demo --help");
  }
  if (!out->frames.empty())
    for (const char* file : {"contact_sheet.png", "still.png", "crowd.png", "animation.mp4", "animation.gif"})
      baker::promise_file(out->frames + "/" + file);
  if (!out->compare.empty() && !out->truth.empty())
    throw baker::BadInput(
        "--compare: not together with --truth; measure each pack against the truth by itself");
  if (out->seconds * std::max(out->fps, 60.0) > kMostFrames) {
    throw baker::BadInput("--seconds x --fps: more than 5 million frames; ask for less");
  }
  return true;
}

}  // namespace sinew::demo
