// status.hpp  What a call that can meet bad data answers. Stand-alone.
#pragma once
#include <cstdint>

#ifdef Status
#error \
    "Status is a macro, as X11/Xlib.h defines it: #undef Status after that header and before sinew's (its type is int)"
#endif

namespace sinew {

// Programmer errors go to the assert hook (see types.hpp); being over budget is a result in FrameReport. A
// Status is for everything that comes from outside: files, poses, definitions.
enum class StatusCode : uint32_t {
  kOk = 0,
  kInvalidArgument = 1,  // a definition, span or number is outside its stated range
  kUnreadable = 2,       // the path cannot be opened, read or mapped
  kNotAPack = 3,         // no .sinew magic: another kind of file, or empty
  kWrongVersion = 4,     // a .sinew of another format version; the message names the command that rebakes it
  kTruncated = 5,        // fewer bytes than the header promises
  kCorrupt = 6,          // a checksum, offset, count or index is wrong
  kUnsupported = 7,      // well-formed, but this build cannot run it
  kOutOfCapacity = 8,    // a limit of WorldDef is reached
  kStaleId = 9,          // the id's object was destroyed, or the id is zero
  kNotFinite = 10,       // NaN or infinity where a finite number is needed
};

// A code and one line: what, where, how to mend. Fixed size, so that making one never allocates.
struct Status {
  StatusCode code = StatusCode::kOk;
  char message[252] = {};  // zero-terminated, cut at the end if longer; empty when ok
  bool ok() const noexcept { return code == StatusCode::kOk; }
};

}  // namespace sinew
