// marker.hpp  A stretch of a step that a profiler is told of.
#pragma once
#include <utility>

#include "sinew/types.hpp"

namespace sinew::world {

class Marker {
 public:
  Marker(const ProfilerHook& hook, const char* name, uint32_t instance) noexcept
      : hook_(hook.begin && hook.end ? &hook : nullptr), name_(name), instance_(instance) {
    if (hook_) hook_->begin(name_, instance_, hook_->context);
  }
  ~Marker() { end(); }
  Marker(const Marker&) = delete;
  Marker& operator=(const Marker&) = delete;

  void end() noexcept {
    if (const ProfilerHook* hook = std::exchange(hook_, nullptr)) hook->end(name_, instance_, hook->context);
  }

 private:
  const ProfilerHook* hook_;
  const char* name_;
  uint32_t instance_;
};

}  // namespace sinew::world
