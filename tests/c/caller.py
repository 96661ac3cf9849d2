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
        one.tier_limit("skinning")
        world.step(np.float32(1 / 60))
        assert one.report()["tier"] == sinew.lib.SINEW_TIER_SKINNING


if __name__ == "__main__":
    main(sys.argv[1])
