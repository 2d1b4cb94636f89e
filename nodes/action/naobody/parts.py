"""The parts of NAO's body that can be locked and released, with the joints of each."""

from __future__ import annotations

from nep_core.errors import ActionFailed
from nodes.action.naobody.body import Body
from nodes.action.naobody.limbs import Limb

PART_OF_LIMB = {Limb.HEAD: "head", Limb.LEFT_ARM: "left_arm", Limb.RIGHT_ARM: "right_arm"}
SINGLE_PARTS = ("head", "left_arm", "right_arm", "left_leg", "right_leg")
PARTS: dict[str, tuple[str, ...]] = {part: (part,) for part in SINGLE_PARTS} | {
    "arms": ("left_arm", "right_arm"),
    "legs": ("left_leg", "right_leg"),
    "body": SINGLE_PARTS,
}
PLAIN_NAMES = {
    "head": "head",
    "left_arm": "left arm",
    "right_arm": "right arm",
    "left_leg": "left leg",
    "right_leg": "right leg",
}


def part_of(body: Body, joint: str) -> str:
    """Return the single part that a joint is in."""
    limb = body.joints[body.index[joint]].limb
    if limb is Limb.LEGS:
        return "left_leg" if joint.startswith("L") else "right_leg"
    return PART_OF_LIMB[limb]


def single_parts(part: str) -> tuple[str, ...]:
    """Return the single parts of a part. Raises ActionFailed with the parts that there are."""
    if part not in PARTS:
        raise ActionFailed(f'There is no part "{part}" of the body. Possible: {", ".join(PARTS)}.')
    return PARTS[part]


def limbs_of_part(part: str) -> frozenset[Limb]:
    """Return the limbs that a part is made of."""
    limbs = {name: limb for limb, name in PART_OF_LIMB.items()}
    return frozenset(limbs.get(name, Limb.LEGS) for name in single_parts(part))


def parts_of_limbs(limbs: frozenset[Limb]) -> frozenset[str]:
    """Return the single parts that some limbs move."""
    parts = {PART_OF_LIMB[limb] for limb in limbs if limb in PART_OF_LIMB}
    return frozenset(parts | ({"left_leg", "right_leg"} if Limb.LEGS in limbs else set()))
