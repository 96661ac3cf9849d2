// main.cpp  sinew-contacts: soft flesh against a Bullet world and its own hands, as pictures and a table.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "baker/common/command_line/program.hpp"
#include "baker/common/files/write_file.hpp"
#include "baker/render/picture/encode.hpp"
#include "samples/contacts/picture.hpp"

namespace {

using namespace sinew;

void print_row(const sample::ContactScene& scene, const sample::ContactMeasured& m) {
  std::printf("%-8s %8.1f %8.4f %10.5f %10.5f %9.3f %8.2f %8u %8u %9.0f %9.0f\n", scene.name.c_str(),
              m.deepest_alone_mm, m.deepest_mm, m.jitter_rms_mm, m.jitter_most_mm, m.creep_mm_s,
              m.volume_most_l, m.vertices_most, m.dropped + m.refused, m.frame_alone_us, m.frame_us);
}

std::vector<sample::ContactScene> scenes_for(const demo::CharacterFile& character) {
  std::vector<sample::ContactScene> scenes = {sample::onto_a_crate(), sample::between_walls()};
  if (std::ranges::any_of(character.view.regions, &pack::RegionRecord::touches_body))
    scenes.push_back(sample::arms_on_the_belly());
  else
    std::printf("No region says touches_body: without the scene of hands on the belly.\n");
  return scenes;
}

int run(const std::string& input, const std::string& output, const sample::ContactPicture& size) {
  const demo::CharacterFile character = demo::open_character(input);
  baker::make_folder(output);
  std::printf("%-8s %8s %8s %10s %10s %9s %8s %8s %8s %9s %9s\n", "scene", "off_mm", "on_mm", "jitter_mm",
              "most_mm", "creep_mm_s", "volume_l", "vertices", "dropped", "off_us", "on_us");
  for (const sample::ContactScene& scene : scenes_for(character)) {
    const sample::ContactPlay play = sample::play(character, scene);
    print_row(scene, play.measured);
    const std::string path = output + "/" + scene.name + ".png";
    render::write_png(path, sample::picture(character, scene, play, size));
  }
  std::printf(
      "off_mm, on_mm: deepest soft vertex inside of a box or a hand, contacts off and on. At rest in "
      "contact: "
      "jitter, rms\n"
      "and most, about a straight line in time; creep, the fastest such line. volume: at most what contacts "
      "take.\n"
      "off_us, on_us: medians of the steps in which something is touched; without contacts mostly asleep.\n"
      "Pictures: %s/*.png\n",
      output.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::string input, output = "out/contacts";
  sample::ContactPicture size;
  CLI::App app(
      "A soft creature leaps onto a crate and is caught between walls, contacts found by Bullet, and hugs "
      "its belly.");
  app.add_option("input", input, "character, .sinew, without rods")->required();
  baker::add_output(app, "-o,--output", output, "folder of the pictures")->capture_default_str();
  app.add_option("--width", size.width, "of each picture, pixels")->check(CLI::Range(16, 4096));
  app.add_option("--height", size.height, "of each picture, pixels")->check(CLI::Range(16, 4096));
  app.add_option("--samples", size.samples, "a pixel")->check(CLI::Range(1, 4096));
  app.add_option("--threads", size.threads, "0: all")->check(CLI::Range(0, 256));
  return baker::run_program("sinew-contacts", app, argc, argv, [&] { return run(input, output, size); });
}
