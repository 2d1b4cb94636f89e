"""The gesture node in a process of its own hears samples and tells gestures."""

import time

import pytest

from nep_core.launcher import Launcher
from nep_core.messages import HUMAN_BEHAVIOR, IMU, NODE_STATE, HumanBehavior, Imu, NodeState
from nep_core.pubsub import Publisher, Subscriber
from nodes.perceptual.recognition.model_file import write_model
from nodes.perceptual.recognition.passages import takes_of
from nodes.sensory.arm.simulate import perform
