"""ALMemory: values by name, and events that tell who wants to know."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

from robots.body.driver import RobotState
from robots.body.motor_tasks import stiffness
from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.service import method, signal

from .arguments import rows, texts
from .module import Module
from .posture import family_of, posture_of

Reader = Callable[[], Any]
CallModule = Callable[..., object]
"""Calls a method of a service, by their names, with its arguments; nobody waits for it."""
REMEMBERED_EVENTS = 50
MOST_KEYS = 20_000
"""A NAO has about 4,000 by itself. Who asks for all names makes others wait that long."""


class Subscriber:
    """What ``ALMemory.subscriber`` gives: its signal is sent with each new value of an event."""

    told = signal("signal::(m)")


class ALMemory(Module):
    """The robot's memory; what its sensors measure is in there, and always fresh."""

    def __init__(self, robot: ServedRobot) -> None:
        super().__init__(robot)
        self._lock = threading.RLock()
        self._data: dict[str, Any] = {}
        self._times: dict[str, float] = {}
        self._history: dict[str, list[list[Any]]] = {}
        self._readers: dict[str, Reader] = {}
        self._subscribers: dict[str, Subscriber] = {}
        self._modules: dict[str, dict[str, tuple[str, str]]] = {}
        self._events: set[str] = set()
        self._micro_events: set[str] = set()
        self._descriptions: dict[str, str] = {}
        self._names: set[str] = set()
        self.call_module: CallModule = lambda module, method, *arguments: None

    def measure(self, readers: dict[str, Reader]) -> None:
        """Add keys that are read anew each time."""
        self._readers |= readers

    def declare(self, *events: str) -> None:
        """Make events known, before they are raised."""
        self._events |= set(events)

    def is_wanted(self, event: str) -> bool:
        """Return whether somebody wants to know of an event."""
        with self._lock:
            return event in self._subscribers or bool(self._modules.get(event))

    def tell(self, event: str, value: Any) -> None:
        """Raise an event, as ``raiseEvent`` does."""
        self._store(event, value)
        with self._lock:
            self._events.add(event)
            history = self._history.setdefault(event, [])
            history.append([value, *_time(self._times[event])])
            del history[:-REMEMBERED_EVENTS]
        self._notify(event, value)

    @method("getData::m(s)", "getData::m(si)")
    def get_data(self, key: str, deprecated: int = 0) -> Any:
        """Return the value of a key. Raises CallFailed when there is none."""
        with self._lock:
            if key in self._data:
                return self._data[key]
            reader = self._readers.get(key)
        if reader is None:
            raise CallFailed("ALMemory has no data “{key}”.", key=key)
        return reader()

    @method("getListData::m(m)")
    def get_list_data(self, keys: Any) -> list[Any]:
        """Return the values of some keys; None for those that there are not."""
        with self._robot.moment():
            return [self._value(key) for key in texts(keys)]

    @method(*(f"insertData::v(s{kind})" for kind in "ifsm"))
    def insert_data(self, key: str, value: Any) -> None:
        """Keep a value. Raises CallFailed when there are too many keys."""
        self._make_known(key)
        self._store(key, value)

    @method("insertListData::v(m)")
    def insert_list_data(self, pairs: Any) -> None:
        """Keep values, given as pairs of key and value."""
        what = "Pairs of key and value"
        for pair in rows(pairs, what):
            if len(rows(pair, what)) < 2:
                raise CallFailed("{what}: one of them is no pair.", what=what)
            self.insert_data(str(pair[0]), pair[1])

    @method("removeData::v(s)")
    def remove_data(self, key: str) -> None:
        """Forget a key."""
        with self._lock:
            if key not in self._data:
                raise CallFailed("ALMemory has no data “{key}”.", key=key)
            self._forget(key)

    data_list = method("getDataList::[s](s)")(
        lambda self, part: [key for key in self.data_list_name() if part in key]
    )

    @method("getDataListName::[s]()")
    def data_list_name(self) -> list[str]:
        """Return all keys."""
        with self._lock:
            return sorted({*self._data, *self._readers, *self._events})

    @method("getType::s(s)")
    def data_type(self, key: str) -> str:
        """Return what kind of value a key has."""
        kinds = {bool: "Bool", int: "Int", float: "Float", str: "String", type(None): "Void"}
        return kinds.get(type(self.get_data(key)), "List")

    @method("getTimestamp::m(s)")
    def timestamp(self, key: str) -> list[Any]:
        """Return the value of a key, with the seconds and microseconds when it was kept."""
        value = self.get_data(key)
        return [value, *_time(self._times.get(key, time.time()))]

    @method("getEventHistory::m(s)")
    def event_history(self, event: str) -> list[list[Any]]:
        """Return the last values of an event, each with seconds and microseconds."""
        with self._lock:
            return list(self._history.get(event, []))

    declare_event = method("declareEvent::v(s)", "declareEvent::v(ss)")(
        lambda self, event, extractor="": self._make_known(event) or self.declare(event)
    )

    @method("getEventList::[s]()")
    def event_list(self) -> list[str]:
        """Return all events."""
        with self._lock:
            return sorted(self._events)

    @method("getMicroEventList::[s]()")
    def micro_event_list(self) -> list[str]:
        """Return all micro events: events without a history."""
        with self._lock:
            return sorted(self._micro_events)

    # Give an event a new value, and tell who wants to know
    raise_event = method("raiseEvent::v(sm)")(
        lambda self, event, value: self._make_known(event) or self.tell(event, value)
    )

    @method("raiseMicroEvent::v(sm)")
    def raise_micro_event(self, event: str, value: Any) -> None:
        """Give a micro event a new value, and tell who wants to know."""
        self._make_known(event)
        self._micro_events.add(event)
        self._store(event, value)
        self._notify(event, value)

    @method("removeEvent::v(s)")
    def remove_event(self, event: str) -> None:
        """Forget an event."""
        with self._lock:
            self._events.discard(event)
            self._forget(event)

    @method("removeMicroEvent::v(s)")
    def remove_micro_event(self, event: str) -> None:
        """Forget a micro event."""
        with self._lock:
            self._micro_events.discard(event)
            self._forget(event)

    @method("subscriber::o(s)")
    def subscriber(self, event: str) -> Subscriber:
        """Return an object whose signal tells each new value of an event."""
        self._make_known(event)
        with self._lock:
            return self._subscribers.setdefault(event, Subscriber())

    @method("subscribeToEvent::v(sss)")
    def subscribe_to_event(self, event: str, module: str, method_name: str) -> None:
        """Call a method of a service at each new value: its event, value, message."""
        self.subscribe_with_message(event, module, "", method_name)

    @method("subscribeToEvent::v(ssss)")
    def subscribe_with_message(
        self, event: str, module: str, message: str, method_name: str
    ) -> None:
        """Call ``method_name`` of the service ``module`` at each new value of an ``event``.

        It gets the event, its value, and the ``message``.
        """
        self._make_known(event)
        with self._lock:
            self._events.add(event)
            self._modules.setdefault(event, {})[module] = (method_name, message)

    @method("subscribeToMicroEvent::v(ssss)")
    def subscribe_to_micro_event(
        self, event: str, module: str, message: str, method_name: str
    ) -> None:
        """Call ``method_name`` of ``module`` with ``message`` at each value of a micro event."""
        self._make_known(event)
        with self._lock:
            self._micro_events.add(event)
            self._modules.setdefault(event, {})[module] = (method_name, message)

    @method("unsubscribeToEvent::v(ss)", "unsubscribeToMicroEvent::v(ss)")
    def unsubscribe_to_event(self, event: str, module: str) -> None:
        """Call a service no more."""
        with self._lock:
            if self._modules.get(event, {}).pop(module, None) is None:
                raise CallFailed(
                    "“{module}” has not subscribed to “{event}”.", module=module, event=event
                )

    @method("getSubscribers::[s](s)")
    def subscribers(self, event: str) -> list[str]:
        """Return the services that want to know of an event."""
        with self._lock:
            return list(self._modules.get(event, {}))

    @method("unregisterModuleReference::v(s)")
    def unregister_module(self, module: str) -> None:
        """Call a service no more, for any event."""
        with self._lock:
            for modules in self._modules.values():
                modules.pop(module, None)

    @method("setDescription::v(ss)")
    def set_description(self, key: str, description: str) -> None:
        """Say what a key is."""
        self._make_known(key)
        self._descriptions[key] = description

    @method("getDescriptionList::m([s])")
    def description_list(self, keys: list[str]) -> list[list[str]]:
        """Return what some keys are: name, kind, description."""
        return [[key, self.data_type(key), self._descriptions.get(key, "")] for key in keys]

    def _make_known(self, name: str) -> None:
        """Take a name in that a program uses. Raises CallFailed when there are too many."""
        with self._lock:
            if name not in self._names and len(self._names) >= MOST_KEYS:
                raise CallFailed(
                    "ALMemory has no room for “{name}”: programs use {most} names already. Remove "
                    "some with removeData or removeEvent, or keep a list under one name.",
                    name=name,
                    most=MOST_KEYS,
                )
            self._names.add(name)

    def _forget(self, name: str) -> None:
        """Forget what is kept under a name; who listens to it goes on listening."""
        for kept in (self._data, self._times, self._history):
            kept.pop(name, None)
        used = (self._events, self._micro_events, self._subscribers, self._descriptions)
        if not self._modules.get(name) and not any(name in one for one in used):
            self._names.discard(name)

    def _value(self, key: str) -> Any:
        try:
            return self.get_data(key)
        except CallFailed:
            return None

    def _store(self, key: str, value: Any) -> None:
        with self._lock:
            self._data[key] = value
            self._times[key] = time.time()

    def _notify(self, event: str, value: Any) -> None:
        with self._lock:
            subscriber = self._subscribers.get(event)
            modules = dict(self._modules.get(event, {}))
        if subscriber is not None:
            subscriber.told.emit(value)
        for module, (name, message) in modules.items():
            self.call_module(module, name, event, value, message)


def _time(seconds: float) -> tuple[int, int]:
    return int(seconds), int(seconds % 1.0 * 1e6)


# What a NAO's sensors write into ALMemory, by NAOqi's keys, read from the robot's state.

DEVICE = "Device/SubDeviceList"
TOUCH_EVENTS = {
    "head_front": "FrontTactilTouched",
    "head_middle": "MiddleTactilTouched",
    "head_rear": "RearTactilTouched",
    "hand_left": "HandLeftBackTouched",
    "hand_right": "HandRightBackTouched",
    "bumper_left": "LeftBumperPressed",
    "bumper_right": "RightBumperPressed",
    "chest_button": "ChestButtonPressed",
}
"""The events of what is touched, by sensor."""
TOUCH_NAMES = {
    "head_front": "Head/Touch/Front",
    "head_middle": "Head/Touch/Middle",
    "head_rear": "Head/Touch/Rear",
    "hand_left": "LHand/Touch/Back",
    "hand_right": "RHand/Touch/Back",
    "bumper_left": "LFoot/Bumper/Left",
    "bumper_right": "RFoot/Bumper/Right",
}
"""What ALTouch calls them."""
MEASURES = {
    f"{DEVICE}/US/Left/Sensor/Value": "sonar_left",
    f"{DEVICE}/US/Right/Sensor/Value": "sonar_right",
    **{
        f"{DEVICE}/InertialSensor/{name}{axis}/Sensor/Value": f"{ours}_{axis.lower()}"
        for name, ours in (("Accelerometer", "acc"), ("Gyroscope", "gyro"))
        for axis in "XYZ"
    },
    f"{DEVICE}/LFoot/FSR/TotalWeight/Sensor/Value": "foot_left",
    f"{DEVICE}/RFoot/FSR/TotalWeight/Sensor/Value": "foot_right",
    "leftFootTotalWeight": "foot_left",
    "rightFootTotalWeight": "foot_right",
    **{f"{DEVICE}/{name}/Sensor/Value": sensor for sensor, name in TOUCH_NAMES.items()},
    f"{DEVICE}/ChestBoard/Button/Sensor/Value": "chest_button",
    **{event: sensor for sensor, event in TOUCH_EVENTS.items()},
}
"""The keys of what RobotState.sensors measures."""


def keys_of(robot: ServedRobot) -> dict[str, Reader]:
    """Return all keys that a robot's state gives a value."""

    def of_state(read: Callable[[RobotState], Any]) -> Reader:
        return lambda: read(robot.state())

    def of_sensor(name: str) -> Reader:
        return of_state(lambda state: state.sensors.get(name, 0.0))

    keys = {key: of_sensor(sensor) for key, sensor in MEASURES.items()}
    for joint in robot.robot.body.names:
        keys |= _keys_of_joint(robot, joint)
    return keys | {
        f"{DEVICE}/Battery/Charge/Sensor/Value": of_state(lambda state: state.battery),
        "BatteryChargeChanged": of_state(lambda state: round(state.battery * 100)),
        "robotIsWakeUp": of_state(lambda state: bool(state.settings["awake"])),
        "ALTextToSpeech/CurrentSentence": of_state(lambda state: state.saying),
        "PostureChanged": lambda: posture_of(robot.robot),
        "PostureFamilyChanged": lambda: family_of(robot.robot),
        "RobotConfig/Body/Type": lambda: "nao",
        "RobotConfig/Head/BaseVersion": lambda: "VERSION_60",
        "RobotConfig/Body/BaseVersion": lambda: "VERSION_60",
        "DCM/Time": lambda: int(time.monotonic() * 1000) & 0x7FFFFFFF,
    }


def _keys_of_joint(robot: ServedRobot, joint: str) -> dict[str, Reader]:
    def angle() -> float:
        return robot.state().joints[joint]

    return {
        f"{DEVICE}/{joint}/Position/Sensor/Value": angle,
        f"{DEVICE}/{joint}/Position/Actuator/Value": angle,
        f"{DEVICE}/{joint}/ElectricCurrent/Sensor/Value": lambda: robot.state().sensors.get(
            f"current_{joint}", 0.0
        ),
        f"{DEVICE}/{joint}/Hardness/Actuator/Value": lambda: stiffness(robot.robot, joint),
    }
