// check_proxies.cpp  Capsules about bones are about bones that are there, and have a size.
#include "pack/checks.hpp"

namespace sinew::pack {

Status check_proxies(const PackView& pack) noexcept {
  if (pack.character->proxy_count > kMostProxies)
    return corrupt("proxies: the character states %u, more than %u", pack.character->proxy_count,
                   kMostProxies);
  if (pack.proxies.size() != pack.character->proxy_count)
    return corrupt("proxies: %zu there, the character states %u", pack.proxies.size(),
                   pack.character->proxy_count);
  for (size_t i = 0; i < pack.proxies.size(); ++i) {
    const ProxyRecord& proxy = pack.proxies[i];
    if (proxy.joint >= pack.joints.size())
      return corrupt("proxy %zu: moves with joint %u of %zu", i, proxy.joint, pack.joints.size());
    if (first_not_finite(proxy.from_m) != 3 || first_not_finite(proxy.to_m) != 3)
      return corrupt("proxy %zu: its ends are not finite", i);
    if (!is_positive(proxy.radius_m)) return corrupt("proxy %zu: radius %g m", i, double{proxy.radius_m});
  }
  return {};
}

}  // namespace sinew::pack
