// main.cpp  Links the installed library: a world is made, stepped, and refuses a file that is not there.
#include <sinew/sinew.hpp>
#ifdef HAS_BULLET
#include <sinew/bullet.hpp>
#endif

int main() {
#ifdef HAS_BULLET
  sinew::BulletContacts contacts;
  if (sinew::BulletContacts::create({}, &contacts).ok() || contacts.apply_impulses() != 0) return 1;
#endif
  sinew::World world;
  if (!sinew::World::create({}, &world).ok()) return 1;
  sinew::AssetId asset;
  if (world.load_asset_file("no such file", &asset).code != sinew::StatusCode::kUnreadable) return 1;
  return world.step(1.0f / 60).instances_network == 0 ? 0 : 1;
}
