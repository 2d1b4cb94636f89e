"""The changes of a motion: each takes one and gives another; nothing is changed in place.

Times are seconds, on a grid of hundredths; angles rad, hands 0 to 1.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterable, Mapping
from itertools import pairwise

from msgspec.structs import replace

from nep_studio.blocks.own_animations import (
    LONGEST_S,
    SHORTEST_STEP_S,
    Handle,
    JointKeys,
    OwnAnimation,
)
from robots.body.keyframes import Keyframes, Track

SAME_S = SHORTEST_STEP_S * 0.999
"""Keys that are nearer to each other than this are at the same time."""

_Key = tuple[float, float, Handle | None]


def key_times(motion: OwnAnimation) -> list[float]:
    """When there are keys, of any joint; nearly equal times are one."""
    found: list[float] = []
    for time in sorted({t for joint in motion.joints.values() for t in joint.times}):
        if not found or time - found[-1] >= SAME_S:
            found.append(time)
    return found


def pose_at(motion: OwnAnimation, time: float) -> dict[str, float]:
    """The angles of the joints that have a key at a time."""
    found = {}
    for name, joint in motion.joints.items():
        for t, angle in zip(joint.times, joint.keys, strict=True):
            if abs(t - time) < SAME_S:
                found[name] = angle
    return found


def with_pose(motion: OwnAnimation, time: float, angles: Mapping[str, float]) -> OwnAnimation:
    """Set keys of some joints at a time."""
    time = usable(time)
    joints = dict(motion.joints)
    for name, angle in angles.items():
        joints[name] = _with_key(joints.get(name), time, angle)
    return replace(motion, joints=joints)


def without_times(motion: OwnAnimation, times: Iterable[float]) -> OwnAnimation:
    """Take away all keys at some times; a joint without a key is not moved any more."""
    gone = sorted(times)
    return _per_joint(motion, lambda keys: [key for key in keys if not _is_at(key[0], gone)])


def moved(motion: OwnAnimation, moves: Mapping[float, float]) -> OwnAnimation:
    """Put the keys at some times to others; a key that was there already makes way."""
    old = sorted(moves)

    def move(keys: list[_Key]) -> list[_Key]:
        stay = [key for key in keys if not _is_at(key[0], old)]
        going = [key for key in keys if _is_at(key[0], old)]
        placed = {t: (t, k[1], k[2]) for k in going for t in [usable(moves[_nearest(k[0], old)])]}
        targets = sorted(placed)
        rest = [key for key in stay if not _is_at(key[0], targets)]
        return sorted([*rest, *placed.values()], key=_time)

    return _per_joint(motion, move)


def without_key(motion: OwnAnimation, joint: str, time: float) -> OwnAnimation:
    """Take away the key of one joint at a time."""
    only = replace(motion, joints={joint: motion.joints[joint]})
    return _with_joint(motion, joint, without_times(only, [time]))


def with_key_moved(
    motion: OwnAnimation, joint: str, time: float, to_s: float, angle: float
) -> OwnAnimation:
    """Put the key of one joint at a time to another time and angle."""
    only = moved(replace(motion, joints={joint: motion.joints[joint]}), {time: to_s})
    return _with_joint(motion, joint, with_pose(only, to_s, {joint: angle}))


def _with_joint(motion: OwnAnimation, joint: str, only: OwnAnimation) -> OwnAnimation:
    """A motion in which one joint does as in another one."""
    joints = {**motion.joints, **only.joints}
    if joint not in only.joints:
        del joints[joint]
    return replace(motion, joints=joints)


def copied(motion: OwnAnimation, times: Iterable[float], seconds: float) -> OwnAnimation:
    """Set the keys at some times once more, so much later."""
    for time in sorted(times):
        motion = with_pose(motion, time + seconds, pose_at(motion, time))
    return motion


def shifted_after(motion: OwnAnimation, time: float, seconds: float) -> OwnAnimation:
    """Put all keys after a time later, or earlier below 0, as far as there is room."""
    later = [t for t in key_times(motion) if t > time + SAME_S]
    if not later:
        return motion
    seconds = min(seconds, LONGEST_S - later[-1])
    seconds = max(seconds, time + SHORTEST_STEP_S - later[0])
    return _per_joint(
        motion, lambda keys: [(_later(k[0], time, seconds), k[1], k[2]) for k in keys]
    )


def stretched(motion: OwnAnimation, factor: float) -> OwnAnimation:
    """Let the motion take ``factor`` times as long, as far as its keys have room."""
    times = [0.0, *key_times(motion)]
    if len(times) == 1:
        return motion
    least = min(late - early for early, late in pairwise(times))
    factor = max(factor, SHORTEST_STEP_S / least) if least > 0 else factor
    factor = min(factor, LONGEST_S / times[-1])
    return from_keyframes(motion, keyframes(motion).stretched(factor))


def with_times(motion: OwnAnimation, new: Mapping[float, float]) -> OwnAnimation:
    """Give every key time another one, in the same order; handles grow with what is around them.

    ``new`` has all of ``key_times`` as its keys.
    """
    old = [0.0, *sorted(new)]
    now = [0.0, *(new[t] for t in old[1:])]
    factors = [(b - a) / (d - c) for a, b, c, d in zip(now, now[1:], old, old[1:], strict=False)]
    factors.append(1.0)

    def change(keys: list[_Key]) -> list[_Key]:
        found = []
        for time, angle, handle in keys:
            place = old.index(_nearest(time, old[1:]))
            if handle is not None:
                before, after = factors[place - 1], factors[place]
                handle = (handle[0] * before, handle[1], handle[2] * after, handle[3])
            found.append((now[place], angle, handle))
        return found

    return _per_joint(motion, change)


def mirrored(motion: OwnAnimation) -> OwnAnimation:
    """The motion as seen in a mirror: left is right."""
    return from_keyframes(motion, keyframes(motion).mirrored())


def backwards(motion: OwnAnimation) -> OwnAnimation:
    """The motion from its last pose to its first."""
    if not motion.joints:
        return motion
    all_keys = keyframes(motion)
    return from_keyframes(motion, all_keys.reversed().delayed(all_keys.first_key_s))


def keyframes(motion: OwnAnimation) -> Keyframes:
    """The motion as the robot's node plays it."""
    tracks = {name: Track(j.times, j.keys, j.handles) for name, j in motion.joints.items()}
    return Keyframes(tracks)


def from_keyframes(motion: OwnAnimation, changed: Keyframes) -> OwnAnimation:
    """A motion with other keys; times are put on the grid of what can be kept."""
    joints = {
        name: JointKeys(tuple(round(t, 5) for t in track.times), track.keys, track.handles)
        for name, track in changed.tracks.items()
    }
    return replace(motion, joints=joints)


def usable(time: float) -> float:
    """The nearest time that a key can have."""
    return min(max(round(time, 2), SHORTEST_STEP_S), LONGEST_S)


def _with_key(joint: JointKeys | None, time: float, angle: float) -> JointKeys:
    if joint is None:
        return JointKeys((time,), (angle,))
    keys = _keys(joint)
    same = [place for place, key in enumerate(keys) if abs(key[0] - time) < SAME_S]
    if same:
        place = same[0]
        keys[place] = (keys[place][0], angle, keys[place][2])
    else:
        place = bisect_left([key[0] for key in keys], time)
        handle = None if joint.handles is None else _smooth_handle(keys, place, time, angle)
        keys.insert(place, (time, angle, handle))
    return _joint(keys)


def _smooth_handle(keys: list[_Key], place: int, time: float, angle: float) -> Handle:
    """Handles for a key between two others: level where the joint turns back, else straight on."""
    if place == 0 or place == len(keys):
        return (0.0, 0.0, 0.0, 0.0)
    (t0, a0, _), (t1, a1, _) = keys[place - 1], keys[place]
    turns_back = (angle - a0) * (a1 - angle) <= 0
    slope = 0.0 if turns_back else (a1 - a0) / (t1 - t0)
    before, after = (time - t0) / 3, (t1 - time) / 3
    return (-before, -slope * before, after, slope * after)


def _per_joint(motion: OwnAnimation, change: Callable[[list[_Key]], list[_Key]]) -> OwnAnimation:
    joints = {}
    for name, joint in motion.joints.items():
        if keys := change(_keys(joint)):
            joints[name] = _joint(keys)
    return replace(motion, joints=joints)


def _keys(joint: JointKeys) -> list[_Key]:
    handles = joint.handles or (None,) * len(joint.times)
    return list(zip(joint.times, joint.keys, handles, strict=True))


def _joint(keys: list[_Key]) -> JointKeys:
    handles = tuple(key[2] for key in keys if key[2] is not None)
    return JointKeys(
        tuple(key[0] for key in keys),
        tuple(key[1] for key in keys),
        handles if len(handles) == len(keys) else None,
    )


def _time(key: _Key) -> float:
    return key[0]


def _later(time: float, after: float, seconds: float) -> float:
    return round(time + seconds, 5) if time > after + SAME_S else time


def _nearest(time: float, times: list[float]) -> float:
    return min(times, key=lambda t: abs(t - time))


def _is_at(time: float, times: list[float]) -> bool:
    return bool(times) and abs(_nearest(time, times) - time) < SAME_S
