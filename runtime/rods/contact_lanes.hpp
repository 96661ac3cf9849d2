// contact_lanes.hpp  Contacts with obstacles several at a time, a contact a lane; between rods one at a time.
//
// In the order in which they come, with the bits of ContactForces' own look, take_over and add.
#pragma once
#include "rods/contact_forces.hpp"
#include "simd/rod_force_job.hpp"

namespace sinew::rods {

class ContactLooks {
 public:
  explicit ContactLooks(const ContactForces& forces) : forces_(forces) {}
  void add(Contact* contact);
  void end();

 private:
  void put(const Contact& contact);
  const ContactForces& forces_;
  size_t count_ = 0;
  Contact* of_[simd::kForceLanes] = {};
  simd::RodLooks lanes_ = {};
};

class ContactTakes {
 public:
  explicit ContactTakes(const ContactForces& forces) : forces_(forces) {}
  void add(Contact* contact);
  void end();

 private:
  void put(const Contact& contact);
  void get(size_t lane);
  const ContactForces& forces_;
  size_t count_ = 0;
  Contact* of_[simd::kForceLanes] = {};
  simd::RodTakes lanes_ = {};
};

class ContactPushes {
 public:
  explicit ContactPushes(const ContactForces& forces) : forces_(forces) {}
  void add(const Contact& contact);
  void end();

 private:
  void put(const Contact& contact);
  void get(size_t lane);
  const ContactForces& forces_;
  size_t count_ = 0;
  const Contact* of_[simd::kForceLanes] = {};
  simd::RodPushes lanes_ = {};
};

}  // namespace sinew::rods
