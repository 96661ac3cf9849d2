// contact_lanes.hpp  Contacts with obstacles several at a time, a contact a lane; between rods one at a time.
//
// In the order in which they come, with the bits of ContactForces' own look, take_over and add.
#pragma once
#include "kernels/rod_contacts/rod_force_job.hpp"
#include "rods/contacts/solve/contact_forces.hpp"

namespace sinew::rods {

template <class Lanes, class Of>
class ContactLanes {
 public:
  explicit ContactLanes(const ContactForces& forces) : forces_(forces) {}

 protected:
  const ContactForces& forces_;
  size_t count_ = 0;
  Of* of_[simd::kForceLanes];
  Lanes lanes_;  // what is not put in may be anything
};

class ContactLooks : ContactLanes<simd::RodLooks, Contact> {
 public:
  using ContactLanes::ContactLanes;
  void add(Contact* contact);
  void end();

 private:
  void put(const Contact& contact);
};

class ContactTakes : ContactLanes<simd::RodTakes, Contact> {
 public:
  using ContactLanes::ContactLanes;
  void add(Contact* contact);
  void end();

 private:
  void put(const Contact& contact);
  void get(size_t lane);
};

class ContactPushes : ContactLanes<simd::RodPushes, const Contact> {
 public:
  using ContactLanes::ContactLanes;
  void add(const Contact& contact);
  void end();

 private:
  void put(const Contact& contact);
  void get(size_t lane);
};

}  // namespace sinew::rods
