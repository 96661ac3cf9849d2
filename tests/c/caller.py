"""caller.py PACK: what the callers of this folder play, through the module `sinew`."""
import sys

import numpy as np

import sinew


def misuse(world, asset, one):
    for wrong, why in ((lambda: world.load("no such file"), "no such file"),
                       (lambda: one.pose(asset.bind_pose()[:1]), "joint"),
                       (lambda: one.pose(np.full_like(asset.bind_pose(), np.nan)), "NaN"),
                       (lambda: sinew.World(max_assets=0), "max_assets"),
                       (lambda: sinew.bake("no such file", "out.sinew"), "no such file")):
        try:
            wrong()
        except sinew.Refused as refused:
            assert why in str(refused), refused
        else:
            raise AssertionError(why)


def tune(world, asset, one):
    swing = {"intensity": 1, "stiffness": 1, "damping": 1, "displacement": 1, "enabled": True}
    assert one.parameters() == swing
    assert one.parameters(stiffness=4, enabled=False) == one.parameters() == {**swing, "stiffness": 4, "enabled": False}
    assert one.parameters(region=asset.regions[0]["name"], damping=2) == one.parameters(region=0) == {**swing, "damping": 2}
    assert one.parameters(rod=asset.rods[0]["name"], intensity=0) == one.parameters(rod=0) == {**swing, "intensity": 0}
    assert world.environment(gravity_m_s2=(0, -2, 0), gust=0.5)["gravity_m_s2"] == [0, -2, 0]
    assert world.environment()["gust"] == 0.5 and world.environment()["wind_m_s"] == [0, 0, 0]
    assert one.environment(wind_m_s=(3, 0, 0)) == one.environment() == {"acceleration_m_s2": [0, 0, 0], "wind_m_s": [3, 0, 0]}
    for wrong, error in ((lambda: one.parameters(stiffness=1000), "stiffness"), (lambda: one.parameters(softness=1), "softness"),
                         (lambda: one.parameters(region="no such"), "no such"), (lambda: one.parameters(region=99), "region"),
                         (lambda: one.parameters(region=0, rod=0), "both"), (lambda: world.environment(gust=2), "gust")):
        try:
            wrong()
        except (ValueError, TypeError) as refused:
            assert error in str(refused), refused
        else:
            raise AssertionError(error)
    assert one.parameters()["stiffness"] == 4


def main(path):
    with sinew.World() as world:
        asset = world.load(path)
        one = world.add(asset)
        misuse(world, asset, one)
        joints = asset.bind_pose()
        for frame in range(60):
            one.pose(joints, root=sinew.root(position=(0, 0.01 * (frame % 20), 0)))
            report = world.step(np.float32(1 / 60))
            assert report["instances_network"] + report["instances_modal"] == 1
        assert asset.joint_path(1).endswith(asset.joints[1]["name"])
        assert abs(one.positions("bind")).max() > 0
        still = np.delete(one.positions("bind"), asset.moved_vertices, axis=0)
        assert not still.any()
        print("\n".join(f"{value:.9g}" for value in one.positions().ravel()))
        tune(world, asset, one)
        one.tier_limit("skinning")
        world.step(np.float32(1 / 60))
        assert one.report()["tier"] == sinew.lib.SINEW_TIER_SKINNING


if __name__ == "__main__":
    main(sys.argv[1])
