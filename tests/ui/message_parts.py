"""The words that sentences take from tables of the sources; no call names them one by one."""

from __future__ import annotations

PARTS = {
    "nep_studio/__main__.py": ["A file could not be read or written"],
    "nep_studio/commands/run.py": ["This project cannot be played like that"],
    "nep_studio/blocks/file_text.py": ["a whole number", "a group of values"],
    "nep_studio/blocks/edit_rules.py": ["1 place"],
    "nep_studio/blocks/operations/copying.py": ["The clipboard"],
    "nep_studio/blocks/checks/flow.py": ["A robot cannot walk after the posture “{label}”."],
    "nep_studio/project/triggers.py": ["A letter or a digit is needed."],
    "nep_studio/run/plan.py": [
        "a rule waits for this gesture",
        "it was asked for",
        "somebody must make the gestures",
    ],
    "nep_studio/run/local_network.py": ["{outcome}; it is started again"],
    "nep_core/processes/manifest.py": [
        'a text, such as "karate"',
        "a number, such as 0.5",
        "a whole number, such as 50",
        "true or false",
        "one of the choices",
        "the name of a file",
    ],
    "nep_core/processes/process.py": [
        "{node} was killed",
        "{node} was asked to stop before it could answer",
        "{node} was interrupted",
        "{node} crashed (it used memory that is not its own)",
        "{node} crashed (it aborted itself)",
        "{node} was ended by signal {number}",
        "{node} was ended by {name}",
        "{node} was stopped",
        "{node} ended by itself",
        "{node} ended because the program that started it is gone",
    ],
    "nodes/cognitive/failures.py": [
        "a number",
        "a text",
        "a list",
        "true or false",
        "a robot",
        "a block",
        "something else",
    ],
    "robots/body/repertoire.py": ["animal"],
    "robots/body/inverse.py": [
        "a face",
        "a mark",
        "the red ball",
        "the face {name}",
        "the mark {name}",
    ],
    "robots/body/surroundings.py": ["a person", "a ball", "a wall"],
    "robots/naoqi/client/session.py": [
        "does not accept this user and password",
        "wants a user and a password",
    ],
    "robots/body/body.py": ["head", "left arm", "right arm", "left leg", "right leg"],
    "robots/body/tasks.py": [
        "gesture",
        "standing",
        "sitting",
        "lying",
        "crouching",
        "resting",
        "sits",
        "lies",
        "crouches",
        "rests",
    ],
    "nodes/perceptual/recognition/features.py": [
        "acceleration",
        "acceleration with gravity",
        "acceleration and rotation",
        "acceleration with gravity and rotation",
    ],
    "nodes/perceptual/recognition/worker.py": [
        "Reading the recordings…",
        "Learning the gestures…",
        "Checking what it learned…",
        "Keeping what it learned…",
    ],
    "nep_core/cli/node.py": [
        "The node {id} has no function run(node, ...) in {module}.",
        "Write one: def run(node, **parameters).",
    ],
    "nodes/sensory/smartwatch.py": [
        "{sender} sends {rate_hz} samples a second",
        "{sender} sends {rate_hz} samples a second, {loss} % get lost",
        "{sender} sends {rate_hz} samples a second: {columns}",
    ],
}
"""By the file that says it; values that are words have no sentence of their own."""

OF_THE_SYSTEM = [
    "address already in use",
    "cannot assign requested address",
    "connection refused",
    "file exists",
    "file name too long",
    "input/output error",
    "is a directory",
    "no space left on device",
    "no such file or directory",
    "it is not a file",
    "not a directory",
    "operation not permitted",
    "permission denied",
    "read-only file system",
]
"""Why a file or an address cannot be used, as the operating system says it."""
