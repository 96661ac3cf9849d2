#!/usr/bin/env python3
# made_up.py  Four made-up characters as artists build them: a cow, a witch, a knight and an ogre.
"""Usage: made_up.py OUTDIR

Writes cow.glb, witch.glb, knight.glb and ogre.glb, the same bytes in every run.
"""
import sys
from pathlib import Path

import numpy as np

from modelling import Limb, lathe, outward, sheet, skin_about, tube
from rigged_glb import Mesh, Rig, write_glb

COLOURS = {"Cow": (0.45, 0.3, 0.2), "Horn": (0.85, 0.8, 0.65), "Robe": (0.3, 0.2, 0.42), "Skin": (0.8, 0.62, 0.5), "Hat": (0.2, 0.14, 0.3),
           "Hair": (0.75, 0.35, 0.12), "Cape": (0.5, 0.1, 0.15), "Wood": (0.45, 0.32, 0.18), "Straw": (0.8, 0.7, 0.35), "Steel": (0.6, 0.63, 0.68),
           "Leather": (0.35, 0.22, 0.14), "Ogre_Skin": (0.42, 0.55, 0.35), "Trousers": (0.35, 0.25, 0.18), "Beard": (0.3, 0.18, 0.1)}


def wave(t, shift=0.0):
    """-1 to 1, once a clip."""
    return np.sin(2 * np.pi * (t + shift))


def leap(t, crouch, rise):
    """Height of a jump: down, thrown, caught and up again."""
    if t < 0.25:
        return -crouch * np.sin(np.pi * t / 0.5)
    if t < 0.7:
        share = (t - 0.25) / 0.45
        return -crouch * (1 - share) * (1 - 2 * share) ** 2 + 4 * rise * share * (1 - share)
    return -crouch * np.sin(np.pi * (t - 0.7) / 0.3)


def skinned(rig, name, limbs, cell, blend, soft_weights, materials, otherwise):
    """A body; each triangle has the material of the bone that moves it most."""
    positions, triangles, weights = skin_about(limbs, rig.names(), cell, blend, soft_weights)
    strongest = weights[triangles].sum(1).argmax(1)
    rig.meshes.append(Mesh(name, positions, triangles, weights, [materials.get(rig.names()[b], otherwise) for b in strongest]))


def rigid(rig, name, surface, bone, material, hangs=False):
    positions, triangles = outward(*surface[:2])
    rig.meshes.append(Mesh(name, positions, triangles, rig.on(bone, len(positions)), [material] * len(triangles), bone if hangs else ""))


def joined(*surfaces):
    positions, triangles, count = [], [], 0
    for surface in surfaces:
        vertices, faces = outward(*surface[:2])
        positions.append(vertices)
        triangles.append(faces + count)
        count += len(vertices)
    return np.concatenate(positions), np.concatenate(triangles)


def along_chain(rig, bones, positions, reach):
    """Weights along a chain: each bone's middle is its own, and neighbours blend over `reach` metres."""
    heads = np.array([rig.heads[b] for b in bones])
    tips = np.concatenate([heads[1:], [2 * heads[-1] - heads[-2]]])
    limbs = [Limb(b, tuple(h), tuple(t), 0, 0) for b, h, t in zip(bones, heads, tips)]
    near = np.stack([limb.distance(positions) for limb in limbs], -1)
    share = np.exp(-(near - near.min(1, keepdims=True)) / reach)
    weights = np.zeros((len(positions), len(rig.names())))
    weights[:, [rig.names().index(b) for b in bones]] = share / share.sum(1, keepdims=True)
    return weights


def cow():
    rig = Rig()
    for name, parent, y, z in (("pelvis", "", 1.28, -0.72), ("spine_01", "pelvis", 1.3, -0.36), ("spine_02", "spine_01", 1.3, 0.0), ("chest", "spine_02", 1.31, 0.36),
                               ("neck", "chest", 1.36, 0.72), ("head", "neck", 1.58, 1.06)):
        rig.bone(name, parent, 0, y, z)
    for leg, parent, z, top in (("hind", "pelvis", -0.72, 1.05), ("fore", "chest", 0.5, 1.0)):
        rig.pair(leg + "_upper{}", parent, 0.2, top, z)
        rig.pair(leg + "_lower{}", leg + "_upper{}", 0.2, 0.56, z + (0.06 if leg == "hind" else -0.02))
        rig.pair(leg + "_hoof{}", leg + "_lower{}", 0.2, 0.13, z)
    tail = [f"tail_0{k}" for k in range(1, 5)]
    for k, bone in enumerate(tail):
        rig.bone(bone, tail[k - 1] if k else "pelvis", 0, 1.28 - 0.22 * k, -0.99 - 0.06 * k)
    rig.pair("ear_01{}", "head", 0.13, 1.74, 1.1)
    rig.pair("ear_02{}", "ear_01{}", 0.25, 1.72, 1.08)
    limbs = [Limb("pelvis", (0, 1.14, -0.78), (0, 1.12, -0.5), 0.27, 0.3), Limb("spine_01", (0, 1.04, -0.4), (0, 1.0, -0.1), 0.36, 0.38),
             Limb("spine_02", (0, 1.0, -0.05), (0, 1.03, 0.2), 0.38, 0.35), Limb("chest", (0, 1.09, 0.3), (0, 1.13, 0.6), 0.32, 0.25),
             Limb("neck", (0, 1.25, 0.68), (0, 1.52, 1.0), 0.22, 0.16), Limb("head", (0, 1.6, 1.08), (0, 1.42, 1.42), 0.16, 0.11)]
    for side, x in (("_l", 0.2), ("_r", -0.2)):
        limbs += [Limb("hind_upper" + side, (x, 1.02, -0.72), (x, 0.6, -0.66), 0.17, 0.11), Limb("hind_lower" + side, (x, 0.54, -0.66), (x, 0.16, -0.72), 0.09, 0.07),
                  Limb("hind_hoof" + side, (x, 0.09, -0.72), (x, 0.08, -0.66), 0.08, 0.08), Limb("fore_upper" + side, (x, 0.98, 0.5), (x, 0.6, 0.48), 0.15, 0.1),
                  Limb("fore_lower" + side, (x, 0.54, 0.48), (x, 0.16, 0.5), 0.085, 0.07), Limb("fore_hoof" + side, (x, 0.09, 0.5), (x, 0.08, 0.56), 0.08, 0.08)]
    skinned(rig, "Cow_Body", limbs, 0.063, 0.03, 0.07, {}, "Cow")
    along = np.linspace(0, 1, 13)
    positions, triangles, _ = tube([(0, 1.28 - 0.86 * s, -0.99 - 0.24 * s) for s in along], [0.04 - 0.02 * s + 0.05 * max(0, s - 0.75) for s in along])
    positions, triangles = outward(positions, triangles)
    rig.meshes.append(Mesh("Cow_Tail", positions, triangles, along_chain(rig, tail, positions, 0.03), ["Cow"] * len(triangles)))
    for side, x in (("_l", 1), ("_r", -1)):
        points = [(x * (0.1 + 0.3 * s), 1.73 - 0.05 * s, 1.1 - 0.04 * s) for s in np.linspace(0, 1, 8)]
        positions, triangles = outward(*tube(points, [0.03, 0.05, 0.065, 0.07, 0.068, 0.055, 0.035, 0.012], squash=0.35)[:2])
        rig.meshes.append(Mesh("Cow_Ear" + side, positions, triangles, along_chain(rig, [f"ear_0{k}{side}" for k in (1, 2)], positions, 0.02), ["Cow"] * len(triangles)))
    horns = [tube([(x * (0.08 + 0.16 * np.sin(1.6 * s)), 1.74 + 0.22 * s ** 2, 1.06 + 0.06 * s) for s in np.linspace(0, 1, 8)], np.linspace(0.04, 0.008, 8)) for x in (1, -1)]
    rigid(rig, "Cow_Horns", joined(*horns), "head", "Horn")

    def gait(t, swing, bob, together):
        pose = {"pelvis": ((5 * bob * wave(t, 0.15) * 10, 0, 2 * wave(t)), (0, bob * wave(2 * t if together else 2 * t, 0.1), 0)),
                "spine_01": (4 * wave(t, 0.3) * together, 2 * wave(t), 0), "spine_02": (-5 * wave(t, 0.3) * together, -2 * wave(t), 0),
                "neck": (4 * wave(2 * t, 0.2), 0, 0), "head": (-4 * wave(2 * t, 0.3), 0, 0)}
        for leg, phase in (("hind", 0.0), ("fore", 0.5 if together else 0.25)):
            for side, lag in (("_l", 0.0), ("_r", 0.12 if together else 0.5)):
                at = phase + lag
                pose[f"{leg}_upper{side}"] = (swing * wave(t, at), 0, 0)
                bend = swing * max(0, wave(t, at + 0.3))
                pose[f"{leg}_lower{side}"] = (bend if leg == "hind" else 1.2 * bend, 0, 0)
                pose[f"{leg}_hoof{side}"] = (0.6 * bend, 0, 0)
        return pose

    def jump(t):
        lift, pitch = leap(t, 0.16, 0.55), -16 * np.sin(2 * np.pi * np.clip((t - 0.15) / 0.7, 0, 1))
        fold = max(0, -lift) * 260
        pose = {"pelvis": ((pitch, 0, 0), (0, lift, 0)), "spine_01": (-0.3 * pitch, 0, 0), "spine_02": (-0.3 * pitch, 0, 0),
                "neck": (-0.4 * pitch, 0, 0), "head": (-0.3 * pitch, 0, 0)}
        tuck = 35 * max(0, lift) / 0.55
        for side in ("_l", "_r"):
            pose |= {"hind_upper" + side: (-0.6 * fold - tuck, 0, 0), "hind_lower" + side: (fold + 1.5 * tuck, 0, 0), "fore_upper" + side: (-0.5 * fold - tuck, 0, 0),
                     "fore_lower" + side: (fold + 1.8 * tuck, 0, 0)}
        return pose

    rig.clips = {"Walk": (1.1, lambda t: gait(t, 24, 0.02, False)), "Gallop": (0.7, lambda t: gait(t, 38, 0.06, True)), "Jump": (1.2, jump)}
    return rig


def human_bones(rig, names, height, hip, shoulder, arm, side_names):
    """Hips, three of the spine, neck, head, arms that hang outwards and legs; lengths as shares of the height."""
    hips, spine, chest, neck, head, upper_arm, fore_arm, hand, thigh, shin, foot = names
    rig.bone(hips, "", 0, 0.53 * height, 0)
    rig.bone(spine, hips, 0, 0.6 * height, 0)
    rig.bone(chest, spine, 0, 0.69 * height, 0)
    rig.bone(neck, chest, 0, 0.82 * height, 0)
    rig.bone(head, neck, 0, 0.87 * height, 0.01 * height)
    def pair(name, parent, x, y, z):
        rig.pair(name, parent, x * height, y * height, z * height, *side_names)
    pair(upper_arm, chest, shoulder, 0.8, 0)
    pair(fore_arm, upper_arm, shoulder + 0.75 * arm, 0.8 - 0.66 * arm, 0)
    pair(hand, fore_arm, shoulder + 1.4 * arm, 0.8 - 1.23 * arm, 0.01)
    pair(thigh, hips, hip, 0.5, 0)
    pair(shin, thigh, hip, 0.27, 0.01)
    pair(foot, shin, hip, 0.05, -0.01)


def human_limbs(rig, names, height, girth, side_names, waist=1.0):
    """Flesh of a human of that girth: 1 is lean."""
    hips, spine, chest, neck, head, upper_arm, fore_arm, hand, thigh, shin, foot = names
    def place(bone):
        return np.array(rig.heads[bone])
    r = height * girth
    limbs = [Limb(hips, place(hips), place(spine), 0.08 * r, 0.075 * r * waist, (1.25, 1, 1)), Limb(spine, place(spine), place(chest), 0.073 * r * waist, 0.08 * r, (1.25, 1, 1)),
             Limb(chest, place(chest), place(neck) - (0, (0.085 * girth - 0.04) * height, 0), 0.085 * r, 0.085 * r, (1.3, 1, 1)), Limb(neck, place(neck), place(head), 0.035 * r, 0.035 * r),
             Limb(head, place(head) + (0, 0.035 * height, 0.01 * height), place(head) + (0, 0.07 * height, 0.01 * height), 0.058 * height, 0.06 * height)]
    for s in side_names:
        out = place(hand.format(s)) - place(fore_arm.format(s))
        limbs += [Limb(upper_arm.format(s), place(upper_arm.format(s)), place(fore_arm.format(s)), 0.038 * r, 0.028 * r),
                  Limb(fore_arm.format(s), place(fore_arm.format(s)), place(hand.format(s)), 0.029 * r, 0.02 * r),
                  Limb(hand.format(s), place(hand.format(s)), place(hand.format(s)) + 0.45 * out, 0.026 * r, 0.02 * r),
                  Limb(thigh.format(s), place(thigh.format(s)), place(shin.format(s)), 0.058 * r, 0.038 * r), Limb(shin.format(s), place(shin.format(s)), place(foot.format(s)), 0.037 * r, 0.025 * r),
                  Limb(foot.format(s), place(foot.format(s)) + (0, -0.02 * height, 0), place(foot.format(s)) + (0, -0.025 * height, 0.08 * height), 0.026 * r, 0.022 * r)]
    return limbs


def human_clips(names, height, side_names, swing, heavy=1.0):
    hips, spine, chest, neck, head, upper_arm, fore_arm, hand, thigh, shin, foot = names
    left, right = side_names

    def stride(t, turn, bob, bend):
        pose = {hips: ((0, 5 * wave(t), 3 * heavy * wave(t, 0.25)), (0, bob * height * wave(2 * t, 0.1), 0)), spine: (bend, -4 * wave(t), -2 * heavy * wave(t, 0.25)),
                chest: (0.5 * bend, -6 * wave(t), 0), neck: (-0.5 * bend, 3 * wave(t), 0), head: (-0.6 * bend, 2 * wave(t), 0)}
        for s, phase in ((left, 0.0), (right, 0.5)):
            pose[thigh.format(s)] = (turn * wave(t, phase), 0, 0)
            pose[shin.format(s)] = (1.2 * turn * max(0, wave(t, phase + 0.3)), 0, 0)
            pose[foot.format(s)] = (-0.4 * turn * wave(t, phase + 0.1), 0, 0)
            pose[upper_arm.format(s)] = (-0.8 * turn * wave(t, phase), 0, 0)
            pose[fore_arm.format(s)] = (-0.6 * turn - 0.3 * turn * wave(t, phase), 0, 0)
        return pose

    def jump(t):
        lift = leap(t, 0.1 * height, 0.3 * height)
        fold = 55 * max(0, -lift) / (0.1 * height)
        pose = {hips: ((0.4 * fold, 0, 0), (0, lift, 0)), spine: (0.2 * fold, 0, 0), chest: (0.15 * fold, 0, 0), neck: (-0.3 * fold, 0, 0), head: (-0.3 * fold, 0, 0)}
        raised = 50 * max(0, lift) / (0.3 * height)
        for s, side in ((left, 1), (right, -1)):
            pose |= {thigh.format(s): (-1.4 * fold, 0, 0), shin.format(s): (1.8 * fold, 0, 0), foot.format(s): (-0.8 * fold, 0, 0),
                     upper_arm.format(s): (0.6 * fold, 0, side * raised), fore_arm.format(s): (-0.5 * fold, 0, 0)}
        return pose

    def strike(t):
        up = np.sin(np.pi * np.clip(t / 0.45, 0, 1)) if t < 0.225 else np.cos(np.pi * np.clip((t - 0.225) / 0.2, 0, 1)) if t < 0.425 else -np.cos(np.pi * np.clip((t - 0.425) / 0.575, 0, 1) / 2)
        return {hips: ((0, -10 * up, 0), (0, -0.02 * height * max(0, -up), 0)), spine: (-6 * up, -12 * up, 0), chest: (-6 * up, -14 * up, 0), neck: (3 * up, 8 * up, 0), head: (4 * up, 14 * up, 0),
                upper_arm.format(right): (-70 - 60 * up, 0, 0), fore_arm.format(right): (-35 - 30 * up, 0, 0),
                upper_arm.format(left): (15 * up, 0, 0), thigh.format(left): (-14 * max(0, -up), 0, 0), thigh.format(right): (12 * max(0, -up), 0, 0)}

    return {"Walk": (1.1, lambda t: stride(t, 0.65 * swing, 0.012, 2)), "Run": (0.7, lambda t: stride(t, 1.2 * swing, 0.03, 10)), "Jump": (1.1, jump), "Attack": (1.0, strike)}


def witch():
    rig, height, sides = Rig(), 1.65, (".L", ".R")
    names = ("hips", "spine", "chest", "neck", "head", "upperarm{}", "forearm{}", "hand{}", "thigh{}", "shin{}", "foot{}")
    human_bones(rig, names, height, 0.05, 0.1, 0.16, sides)
    limbs = human_limbs(rig, names, height, 0.95, sides, 0.9)
    limbs += [Limb("hips", (0, 0.88, 0), (0, 0.72, 0), 0.15, 0.19)]
    limbs += [Limb(f"{bone}{s}", (x * 0.09, high, 0), (x * 0.11, low, 0), r, r + 0.03) for s, x in ((".L", 1), (".R", -1)) for bone, high, low, r in (("thigh", 0.68, 0.48, 0.15), ("shin", 0.42, 0.26, 0.17))]
    limbs += [Limb("head", (0, 1.5, 0.1), (0, 1.47, 0.17), 0.025, 0.018)]  # a nose
    skin = {bone: "Skin" for bone in ("head", "neck", "hand.L", "hand.R")}
    skinned(rig, "Witch_Body", limbs, 0.045, 0.018, 0.03, skin, "Robe")
    top = 1.585
    rigid(rig, "Witch_Hat", lathe((0, top, 0.02), [(0.12, 0), (0.29, 0.005), (0.3, 0.02), (0.14, 0.035), (0.125, 0.07), (0.1, 0.17), (0.07, 0.27), (0.045, 0.35), (0.015, 0.43)], 20, (0.03, -0.14)), "head", "Hat")
    locks = [Limb("head", (0, 1.54, -0.03), (0, 1.47, -0.06), 0.115, 0.115)]
    for x in (-0.09, -0.03, 0.03, 0.09):  # over the cape
        locks += [Limb("head", (x, 1.48, -0.13), (1.1 * x, 1.32, -0.25), 0.055, 0.05, (1, 1, 0.8)), Limb("head", (1.1 * x, 1.32, -0.25), (1.3 * x, 0.95, -0.33), 0.05, 0.035, (1, 1, 0.8))]
    positions, triangles, _ = skin_about(locks, rig.names(), 0.035, 0.012, 1)
    rigid(rig, "Witch_Hair", (positions, triangles), "head", "Hair")
    u, v = np.meshgrid(np.linspace(-1, 1, 11), np.linspace(0, 1, 15))
    spread = 0.19 + 0.16 * v
    front = np.stack([spread * np.sin(1.25 * u), 1.34 - 0.98 * v, -0.02 - (0.14 + 0.16 * v) * np.cos(1.25 * u)], -1)
    inner = np.stack([(spread - 0.012) * np.sin(1.25 * u), 1.34 - 0.98 * v, -0.02 - (0.128 + 0.16 * v) * np.cos(1.25 * u)], -1)
    rigid(rig, "Witch_Cape", sheet(front, inner), "chest", "Cape")
    hand = rig.heads["hand.R"]
    stick = tube([hand + (-0.05, -0.07, z) for z in np.linspace(-0.75, 0.6, 8)], [0.016] * 8)
    straw = tube([hand + (-0.05, -0.07, z) for z in (-1.2, -1.15, -1.0, -0.85, -0.75)], [0.1, 0.1, 0.09, 0.06, 0.025], 10)
    rigid(rig, "Witch_Broom", joined(stick, straw), "hand.R", "Wood", hangs=True)
    rig.clips = human_clips(names, height, sides, 22)
    return rig


def knight():
    rig, height, sides = Rig(), 1.85, ("_L", "_R")
    names = ("Hips", "Spine", "Chest", "Neck", "Head", "UpperArm{}", "LowerArm{}", "Hand{}", "UpperLeg{}", "LowerLeg{}", "Foot{}")
    human_bones(rig, names, height, 0.055, 0.12, 0.16, sides)
    limbs = human_limbs(rig, names, height, 1.12, sides)
    limbs += [Limb("Chest", (0, 1.33, 0.06), (0, 1.24, 0.07), 0.15, 0.13, (1.15, 1, 1)), Limb("Hips", (0, 1.0, 0), (0, 0.9, 0), 0.17, 0.2, (1.1, 1, 0.9))]
    leather = {bone: "Leather" for bone in ("Hand_L", "Hand_R", "Neck")}
    skinned(rig, "Knight_Body", limbs, 0.04, 0.015, 0.02, leather, "Steel")
    rigid(rig, "Knight_Helmet", lathe((0, 1.58, 0.02), [(0.1, 0), (0.13, 0.02), (0.135, 0.12), (0.135, 0.2), (0.11, 0.28), (0.06, 0.33), (0.015, 0.36)], 16), "Head", "Steel")
    for side, x in (("L", 1), ("R", -1)):
        at = rig.heads[f"UpperArm_{side}"]
        rigid(rig, f"Knight_Pauldron_{side}", lathe(at + (x * 0.03, -0.04, 0), [(0.15, 0), (0.16, 0.03), (0.14, 0.09), (0.09, 0.14), (0.02, 0.16)], 12), f"UpperArm_{side}", "Steel")
    hand = rig.heads["Hand_R"] + (-0.03, -0.06, 0)
    blade = tube([hand + (0, 0, z) for z in (-0.16, -0.12, 0.1, 0.12, 0.2, 0.85, 1.0)], [0.02, 0.018, 0.018, 0.1, 0.035, 0.03, 0.004], 8, 0.4)
    rigid(rig, "Knight_Sword", blade, "Hand_R", "Steel", hangs=True)
    hand = rig.heads["Hand_L"] + (0.07, 0, 0)
    u, v = np.meshgrid(np.linspace(-1, 1, 9), np.linspace(0, 1, 11))
    width = 0.26 * np.sqrt(np.maximum(1 - np.clip(v - 0.35, 0, 1) / 0.66, 0.0005))
    outer = np.stack([hand[0] + 0.08 * (1 - u ** 2), hand[1] + 0.3 - 0.75 * v, hand[2] + width * u], -1)
    rigid(rig, "Knight_Shield", sheet(outer, outer - (0.025, 0, 0)), "Hand_L", "Steel", hangs=True)
    rig.clips = human_clips(names, height, sides, 28)
    return rig


def ogre():
    rig, height, sides = Rig(), 2.4, ("Left", "Right")
    names = ("Hips", "Spine", "Spine1", "Neck", "Head", "{}Arm", "{}ForeArm", "{}Hand", "{}UpLeg", "{}Leg", "{}Foot")
    names = tuple("mixamorig:" + name for name in names)
    human_bones(rig, names, height, 0.08, 0.16, 0.18, sides)
    limbs = human_limbs(rig, names, height, 1.3, sides)
    hips, spine, chest = names[:3]
    limbs += [Limb(spine, (0, 1.42, 0.16), (0, 1.3, 0.22), 0.34, 0.37), Limb(hips, (0, 1.2, 0.08), (0, 1.14, 0.04), 0.33, 0.3), Limb(chest, (0, 1.7, 0.04), (0, 1.6, 0.06), 0.26, 0.3, (1.3, 1, 0.9))]
    limbs += [Limb(names[4], (0, 2.22, 0.12), (0, 2.17, 0.2), 0.05, 0.055)]  # a nose
    limbs += [Limb(names[4], (x * 0.14, 2.24, 0.02), (x * 0.25, 2.28, -0.02), 0.04, 0.03) for x in (1, -1)]
    trousers = {bone: "Trousers" for bone in (hips, *(b.format(s) for b in names[8:10] for s in sides))}
    skinned(rig, "Ogre_Body", limbs, 0.075, 0.03, 0.07, trousers, "Ogre_Skin")
    at = np.array([0, 2.12, 0.16])
    beard = [Limb(names[4], tuple(at + (x, 0.05, -0.04)), tuple(at + (0.6 * x, -0.04, 0.05)), 0.05, 0.06) for x in (-0.1, 0.1)]
    beard += [Limb(names[4], tuple(at + (0, -0.03, 0.04)), tuple(at + (0, -0.36, 0.27)), 0.1, 0.04, (1.2, 1, 0.8))]
    positions, triangles, _ = skin_about(beard, rig.names(), 0.035, 0.012, 1)
    rigid(rig, "Ogre_Beard", (positions, triangles), names[4], "Beard")
    rig.clips = human_clips(names, height, sides, 26, heavy=2)
    return rig


CHARACTERS = {"cow": cow, "witch": witch, "knight": knight, "ogre": ogre}


def write_all(folder):
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in CHARACTERS.items():
        write_glb(make(), folder / f"{name}.glb", COLOURS)


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    write_all(Path(sys.argv[1]))


if __name__ == "__main__":
    main()
