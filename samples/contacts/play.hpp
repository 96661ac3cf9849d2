// play.hpp  A scene played with contacts and without, side by side.
#pragma once
#include "samples/contacts/scenes.hpp"
#include "samples/demo/character_file.hpp"

namespace sinew::sample {

struct ContactMoment {
  struct Surface {
    std::vector<Eigen::Vector3f> places;  // world
    std::vector<float> depths_m;          // that each vertex is inside of something: soft ones alone
  };
  double time_s = 0;
  Surface alone, touching;  // of the same instant
  render::Mesh boxes;
};

// Over all frames; depths of vertices that tissue moves, by the boxes themselves.
struct ContactMeasured {
  double deepest_alone_mm = 0, deepest_mm = 0;
  // While all stands: about a straight line in time, and the fastest such line.
  double jitter_rms_mm = 0, jitter_most_mm = 0, creep_mm_s = 0;
  double volume_most_l = 0;
  double frame_alone_us = 0, frame_us = 0;  // medians of the steps in which something is touched
  uint32_t vertices_most = 0, dropped = 0, refused = 0;
};

struct ContactPlay {
  std::vector<ContactMoment> moments;
  ContactMeasured measured;
};

// Throws baker::BadInput with what the world refused.
ContactPlay play(const demo::CharacterFile& character, const ContactScene& scene);

}  // namespace sinew::sample
