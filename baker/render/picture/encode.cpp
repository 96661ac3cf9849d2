// encode.cpp  see encode.hpp.
#include "baker/render/picture/encode.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <cerrno>
#include <cstring>
#include <vector>

#include "baker/common/files/kept_files.hpp"

extern char** environ;

namespace sinew::render {
namespace {

std::string filter(const Film& film) {
  const std::string width = film.max_width > 0 ? "'min(iw," + std::to_string(film.max_width) + ")'" : "iw";
  if (film.path.ends_with(".gif")) {
    // One palette for the whole film, and differences only: small, and steady where nothing moves.
    return "scale=w=" + width +
           ":h=-1:flags=lanczos,split[a][b];[a]palettegen=stats_mode=full[p];"
           "[b][p]paletteuse=dither=bayer:bayer_scale=4:diff_mode=rectangle";
  }
  return "scale=w=trunc(" + width + "/2)*2:h=-2:flags=lanczos,format=yuv420p";  // H.264 needs even sides
}

std::vector<std::string> arguments(const Film& film) {
  std::vector<std::string> list = {
      "ffmpeg", "-nostdin",   "-loglevel", "error",     "-y", "-framerate", std::to_string(film.fps),
      "-i",     film.pattern, "-vf",       filter(film)};
  if (film.path.ends_with(".mp4"))
    list.insert(list.end(), {"-c:v", "libx264", "-crf", "18", "-movflags", "+faststart"});
  list.push_back(film.path);
  return list;
}

}  // namespace

std::string encode(const Film& film) {
  baker::refuse_over_kept(film.path);
  std::vector<std::string> list = arguments(film);
  std::vector<char*> argv;
  for (std::string& argument : list) argv.push_back(argument.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  const int failure = posix_spawnp(&child, "ffmpeg", nullptr, nullptr, argv.data(), environ);
  if (failure == ENOENT) return "ffmpeg is not installed: no " + film.path + "; the frames are there as PNG";
  if (failure != 0)
    return std::string("ffmpeg did not start (") + std::strerror(failure) + "): no " + film.path;
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  return "ffmpeg could not make " + film.path + "; the frames are there as PNG";
}

}  // namespace sinew::render
