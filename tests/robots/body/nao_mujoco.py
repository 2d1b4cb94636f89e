"""NAO in MuJoCo, made from our body.json: does it stay on its feet while it plays an animation?

MuJoCo judges our animations from outside and never enters the program.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from xml.etree import ElementTree as Xml

import mujoco
import numpy as np
from nao_capsules import BODY, SKELETON
from numpy.typing import NDArray

from robots.body.body import Angles, Joint, Link
from robots.body.kinematics import TORSO
from robots.body.motion import TICK_S

STEPS_A_TICK = 5
SOLE_THICK_M = 0.01
ARMATURE_KG_M2 = 0.004
"""A motor's own inertia behind its gears."""
TORQUES_NM = {
    "Head": 1.5,
    "ShoulderPitch": 1.33,
    "ShoulderRoll": 1.78,
    "Elbow": 1.53,
    "Wrist": 0.41,
    "HipYawPitch": 3.35,
    "HipRoll": 3.35,
    "AnkleRoll": 3.35,
    "Hip": 3.02,
    "Knee": 3.02,
    "Ankle": 3.02,
}
"""What motors can do. Source: nao_description V50 URDF."""
FALLEN_RAD = math.radians(35.0)
"""A foot, or what should stand on it, tips no further than this and comes back."""


@dataclass(frozen=True)
class Ground:
    """How firm motors are (``gain`` Nm/rad), and how little the floor lets feet slide."""

    gain: float
    friction: float


@dataclass(frozen=True)
class Outcome:
    """How a play ended: how far the soles tipped at most (rad), and whether the robot fell."""

    tilt_rad: float
    has_fallen: bool


def played(angles: Angles, ground: Ground) -> Outcome:
    """Play the angles of every joint (ticks, joints) at TICK_S; stand still for a while after."""
    model = mujoco.MjModel.from_xml_string(_model(ground))
    data = mujoco.MjData(model)
    columns = _columns(model)
    _put_down(model, data, angles[0])
    feet = [model.body(name).id for name in SKELETON.soles]
    tilt_rad = 0.0
    for row in (*angles, *np.repeat(angles[-1:], 100, axis=0)):
        data.ctrl[:] = row[columns]
        mujoco.mj_step(model, data, STEPS_A_TICK)
        upright = [float(data.xmat[foot][8]) for foot in feet]
        tilt_rad = max(tilt_rad, math.acos(max(-1.0, min(1.0, min(upright)))))
    return Outcome(tilt_rad, tilt_rad > FALLEN_RAD)


def carried_at(angles: Angles) -> NDArray[np.float64]:
    """Where the floor must carry the robot for a movement (ticks - 2, 2), by inverse dynamics."""
    model = mujoco.MjModel.from_xml_string(_model(Ground(100.0, 1.0)))
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    model.dof_armature[:] = 0.0
    data = mujoco.MjData(model)
    poses = np.array([_whole_pose(model, row) for row in angles])
    speeds = np.zeros((len(poses) - 1, model.nv))
    for speed, before, after in zip(speeds, poses, poses[1:], strict=False):
        mujoco.mj_differentiatePos(model, speed, TICK_S, before, after)
    points = []
    for pose, before, after in zip(poses[1:], speeds, speeds[1:], strict=False):
        data.qpos[:], data.qvel[:] = pose, (before + after) / 2.0
        data.qacc[:] = (after - before) / TICK_S
        mujoco.mj_inverse(model, data)
        force, torque = data.qfrc_inverse[:3], data.qfrc_inverse[3:6]
        turn = data.xmat[model.body(TORSO).id].reshape(3, 3)
        moment = turn @ torque + np.cross(pose[:3], force)
        points.append((-moment[1] / force[2], moment[0] / force[2]))
    return np.array(points)


def _whole_pose(model: mujoco.MjModel, angles: Angles) -> NDArray[np.float64]:
    """The torso's place and turn, then every joint, as MuJoCo has them."""
    turn, place = _standing(angles)
    pose = np.zeros(model.nq)
    pose[:3] = place
    mujoco.mju_mat2Quat(pose[3:7], turn.ravel())
    pose[7:] = angles[_columns(model)]
    return pose


def _columns(model: mujoco.MjModel) -> list[int]:
    return [BODY.index[model.actuator(number).name] for number in range(model.nu)]


def _put_down(model: mujoco.MjModel, data: mujoco.MjData, angles: Angles) -> None:
    """Put the robot on its soles, and let it come to rest."""
    data.qpos[:] = _whole_pose(model, angles)
    data.ctrl[:] = angles[_columns(model)]
    mujoco.mj_step(model, data, 50 * STEPS_A_TICK)


def _standing(angles: Angles) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """How the torso is turned (3, 3) and where it is when the left sole is flat on the floor."""
    foot = SKELETON.transforms(angles)[SKELETON.index["L_ankle"]]
    turn = foot[:3, :3].T
    place = -turn @ foot[:3, 3] - (0.0, 0.0, SKELETON.soles["L_ankle"][0, 2])
    return turn, place


def _model(ground: Ground) -> str:
    root = Xml.Element("mujoco")
    Xml.SubElement(root, "option", timestep=str(TICK_S / STEPS_A_TICK), integrator="implicitfast")
    world = Xml.SubElement(root, "worldbody")
    meshes = Xml.SubElement(root, "asset")
    motors = Xml.SubElement(root, "actuator")
    friction = f"{ground.friction} 0.005 0.0001"
    Xml.SubElement(world, "geom", type="plane", size="5 5 1", friction=friction)
    torso = Xml.SubElement(world, "body", name=TORSO)
    Xml.SubElement(torso, "freejoint")
    bodies = {TORSO: torso}
    _fill(torso, meshes, TORSO, BODY.links[TORSO], friction)
    waiting = [joint for joint in BODY.joints if joint.child]
    while waiting:
        joint = waiting.pop(0)
        if joint.parent not in bodies:
            waiting.append(joint)
            continue
        bodies[joint.child] = _jointed(bodies[joint.parent], motors, joint, ground)
        _fill(bodies[joint.child], meshes, joint.child, BODY.links[joint.child], friction)
    return Xml.tostring(root, encoding="unicode")


def _jointed(parent: Xml.Element, motors: Xml.Element, joint: Joint, ground: Ground) -> Xml.Element:
    body = Xml.SubElement(parent, "body", name=joint.child, pos=_numbers(joint.origin_m))
    Xml.SubElement(
        body,
        "joint",
        name=joint.name,
        axis=_numbers(joint.axis),
        range=_numbers(np.degrees([joint.min_rad, joint.max_rad])),
        limited="true",
        armature=str(ARMATURE_KG_M2),
    )
    torque = next(nm for part, nm in TORQUES_NM.items() if part in joint.name)
    Xml.SubElement(
        motors,
        "position",
        name=joint.name,
        joint=joint.name,
        kp=str(ground.gain),
        kv=str(0.05 * ground.gain),
        forcerange=_numbers((-torque, torque)),
    )
    return body


def _fill(body: Xml.Element, meshes: Xml.Element, name: str, link: Link, friction: str) -> None:
    """Give a body its mass, and what of it touches the floor."""
    Xml.SubElement(
        body,
        "inertial",
        pos=_numbers(link.centre_m),
        mass=str(link.mass_kg),
        fullinertia=_numbers(link.inertia_kg_m2),
    )
    touching = {"contype": "0", "conaffinity": "1", "friction": friction}
    if link.sole_m:
        corners = [(x, y, z + up) for x, y, z in link.sole_m for up in (0.0, SOLE_THICK_M)]
        Xml.SubElement(meshes, "mesh", name=name, vertex=_numbers(np.ravel(corners)))
        Xml.SubElement(body, "geom", type="mesh", mesh=name, **touching)
        return
    for *place, radius in link.hull_m:
        Xml.SubElement(
            body, "geom", type="sphere", pos=_numbers(place), size=str(radius), **touching
        )


def _numbers(values: Iterable[float]) -> str:
    return " ".join(f"{value:.8g}" for value in values)
