// check_proxies.cpp  Capsules about bones are about bones that are there, and have a size.
#include "pack/checks/checks.hpp"

namespace sinew::pack {

Status check_proxies(const PackView& pack) noexcept {
  if (pack.character->proxy_count > kMostProxies)
    return corrupt("body colliders: the character states %u, more than %u", pack.character->proxy_count,
                   kMostProxies);
  if (pack.proxies.size() != pack.character->proxy_count)
    return corrupt("body colliders: %zu there, the character states %u", pack.proxies.size(),
                   pack.character->proxy_count);
  for (size_t i = 0; i < pack.proxies.size(); ++i) {
    const ProxyRecord& proxy = pack.proxies[i];
    if (proxy.joint >= pack.joints.size())
      return corrupt("body collider %zu: moves with joint %u of %zu", i, proxy.joint, pack.joints.size());
    if (!are_within(proxy.from_m, kFarthest_m) || !are_within(proxy.to_m, kFarthest_m))
      return corrupt("body collider %zu: its ends are not within +-1e5 m", i);
    if (!is_within(proxy.radius_m, kLeastSize_m, kFarthest_m))
      return corrupt("body collider %zu: radius %g m", i, double{proxy.radius_m});
  }
  return {};
}

}  // namespace sinew::pack
