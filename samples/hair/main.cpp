// main.cpp  sinew-hair: hair over the shoulders of a turning character, as pictures and a line of figures.
#include <cstdio>
#include <filesystem>

#include "baker/common/command_line/within.hpp"
#include "baker/common/files/write_file.hpp"
#include "baker/render/picture/layout.hpp"
#include "samples/hair/picture.hpp"
#include "samples/hair/tiers.hpp"

namespace {

using namespace sinew;

struct Request {
  std::string folder;
  std::vector<std::string> against;
  uint32_t steps = 960;
  size_t vertices = 6000;
  sample::HairStyle style;
  sample::HairPicture size;
  std::vector<double> moments_s = {0, 2.2, 3.1, 4.3, 5.2, 6.3};
};

struct Named {
  const char* name;
  sample::Against against;
  const char* title;
};
constexpr Named kAll[] = {{"nothing", sample::Against::kNothing, "Hair that collides with nothing"},
                          {"proxies", sample::Against::kProxies, "Hair against capsules of the bones"},
                          {"skin", sample::Against::kSkin, "Hair against the skinned mesh"}};

void run(const Request& request, const Named& named) {
  sample::Hair hair(request.style, named.against, request.vertices);
  std::vector<render::Cell> cells;
  const auto look = [&] {
    if (cells.size() == request.moments_s.size() || hair.time_s() < request.moments_s[cells.size()] - 1e-3)
      return;
    char caption[32];
    std::snprintf(caption, sizeof caption, "%.1f s", hair.time_s());
    cells.push_back({sample::picture(hair, request.size), caption});
  };
  look();
  for (uint32_t i = 0; i < request.steps; ++i) {
    hair.step(true);
    look();
  }
  std::printf("%s\n", sample::report_line(hair, named.name).c_str());
  const std::string path =
      std::filesystem::path(request.folder) / (std::string("hair_") + named.name + ".png");
  render::write_png(path, render::contact_sheet(cells, 3, named.title));
  std::printf("%s\n", path.c_str());
  std::fflush(stdout);
}

constexpr uint32_t kSettling = 60;  // ticks

void tell(sample::TieredHair& hair, const char* name, sample::Touches touches, uint32_t ticks) {
  (void)hair.take_measure();
  for (uint32_t i = 0; i < ticks; ++i) hair.step(touches, true);
  std::printf("%s\n", sample::tier_line(hair, name).c_str());
  std::fflush(stdout);
}

void tell(const char* to, const sample::TierJump& jump, double height_m) {
  std::printf(
      "a change %s moves the end of a bone by %.2f mm a frame beyond what it does on either, %.3f %% of the "
      "height, and in the 44 frames after those by %.2f mm\n",
      to, 1e3 * jump.after_m, 100 * jump.after_m / height_m, 1e3 * jump.later_m);
}

void skip(sample::TieredHair& hair, sample::Touches touches, uint32_t ticks) {
  for (uint32_t i = 0; i < ticks; ++i) hair.step(touches);
}

// A row on capsules, one on skin.
void show_tiers(const Request& request, sample::TieredHair& hair) {
  const auto start = hair.mark();
  std::vector<render::Cell> cells;
  for (const sample::Touches touches : {sample::Touches::kCapsules, sample::Touches::kSkin}) {
    hair.go_back(start);
    for (const double moment_s : {2.2, 3.1, 4.3}) {
      while (hair.time_s() < moment_s - 1e-3) hair.step(touches);
      char caption[40];
      std::snprintf(caption, sizeof caption, "%s, %.1f s",
                    touches == sample::Touches::kSkin ? "skin" : "capsules", moment_s);
      cells.push_back({sample::picture(hair, request.size), caption});
    }
  }
  const std::string path = std::filesystem::path(request.folder) / "hair_tiers.png";
  render::write_png(path, render::contact_sheet(cells, 3, "What hair touches follows the control graph"));
  std::printf("%s\n", path.c_str());
}

void run_tiers(const Request& request) {
  sample::TieredHair hair(request.style, request.vertices);
  const auto start = hair.mark();
  const uint32_t ticks = request.steps / 2;
  for (const sample::Touches touches : {sample::Touches::kSkin, sample::Touches::kCapsules}) {
    hair.go_back(start);
    skip(hair, touches, kSettling);
    tell(hair, touches == sample::Touches::kSkin ? "finest graph" : "coarser graph", touches, ticks);
  }
  skip(hair, sample::Touches::kSkin, 3 * kSettling);
  tell(hair, "finest graph, three seconds after that", sample::Touches::kSkin, ticks);
  hair.go_back(start);
  show_tiers(request, hair);
  hair.go_back(start);
  const sample::TierJumps jumps = sample::tier_jumps(hair, ticks);
  tell("to capsules", jumps.to_capsules, hair.height_m());
  tell("to the skin", jumps.to_skin, hair.height_m());
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  CLI::App app("Hair over the shoulders of a turning character, with how deep it goes below the skin.");
  app.add_option("-o,--output", request.folder, "folder of the pictures")->required();
  app.add_option("--against", request.against, "'nothing', 'proxies', 'skin' or 'tiers'; without: all")
      ->check(CLI::IsMember({"nothing", "proxies", "skin", "tiers"}));
  app.add_option("--steps", request.steps, "of a hundred-and-twentieth of a second")
      ->check(CLI::Range(1, 1000000));
  app.add_option("--strands", request.style.strands, "locks of hair")->check(CLI::Range(1, 20000));
  app.add_option("--segments", request.style.segments, "of each")->check(CLI::Range(2, 1000));
  app.add_option("--vertices", request.vertices, "of the skin")->check(CLI::Range(200, 200000));
  app.add_option("--width", request.size.width, "of each moment, pixels")->check(CLI::Range(16, 8192));
  app.add_option("--height", request.size.height, "of each moment, pixels")->check(CLI::Range(16, 8192));
  app.add_option("--samples", request.size.samples, "a pixel")->check(CLI::Range(1, 4096));
  app.add_option("--yaw", request.size.yaw_deg, "0: from the front, 180: from behind")
      ->check(baker::within(-360, 360, "-360 to 360 degrees"));
  try {
    app.parse(argc, argv);
    baker::make_folder(request.folder);
    for (const Named& named : kAll) {
      const bool wanted =
          std::find(request.against.begin(), request.against.end(), named.name) != request.against.end();
      if (request.against.empty() || wanted) run(request, named);
    }
    const bool tiers =
        std::find(request.against.begin(), request.against.end(), "tiers") != request.against.end();
    if (request.against.empty() || tiers) run_tiers(request);
    return 0;
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "sinew-hair: %s\n", problem.what());
    return 2;
  }
}
