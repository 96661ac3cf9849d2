// hair.hpp  Hair on a turning bust, stepped and measured.
#pragma once
#include <string>

#include "rods/rod_batch.hpp"
#include "samples/hair/groom.hpp"
#include "sinew/surface_contacts.hpp"

namespace sinew::sample {

enum class Against { kNothing, kProxies, kSkin };

struct HairMeasure {
  uint64_t steps = 0, unconverged = 0, contacts_unconverged = 0, recovered = 0, contacts = 0,
           contacts_most = 0, dropped = 0;
  // Below the skin at a step's end, of a lock's radius: deepest of all, and how many of all ends and nearest
  // points of segments were deeper than a twentieth.
  double deepest = 0;
  uint64_t looked_at = 0, deeper_than_a_twentieth = 0;
  double longest = 1;                     // of a strand, over its length at rest
  std::vector<double> rods_us, refit_us;  // a step's; of refit_us the tree's
};

class Hair {
 public:
  Hair(const HairStyle& style, Against against, size_t vertices);
  // One tick of a hundred-and-twentieth of a second. `measures`: looks for penetration as well, which is not
  // timed.
  void step(bool measures);

  double time_s() const { return time_s_; }
  const HairMeasure& measure() const { return measure_; }
  const Bust& bust() const { return bust_; }
  const std::vector<std::vector<rods::SegmentDef>>& strands() const { return strands_; }
  const rods::RodBatch& batch() const { return batch_; }

 private:
  void hold_roots(const Turning& turning);
  void place_proxies(const Turning& before, const Turning& now);
  void look();

  Bust bust_;
  std::vector<std::vector<rods::SegmentDef>> strands_;
  rods::RodBatch batch_;
  rods::RodCollider collider_;
  Against against_;
  SurfaceContacts skin_, looked_at_;
  SurfaceId skin_id_, looked_id_;
  std::vector<ContactProbe> probes_;
  std::vector<ContactHit> hits_;
  double time_s_ = 0;
  HairMeasure measure_;
};

std::string report_line(const Hair& hair, const char* name);

// The skin as something to touch, where it is at rest.
SurfaceContacts skin_of(const Bust& bust, SurfaceId* id);
double thread_us();
double median(std::vector<double> values);

}  // namespace sinew::sample
