"""The services of eyes and ears: faces, marks, balls, sounds and distances."""

from __future__ import annotations

from typing import Any

from nodes.action.naobody.face_tasks import forget_all_faces
from nodes.action.naobody.surroundings import SONAR_RANGE_M
from nodes.action.naoqi.server import CallFailed, method
from nodes.action.naoqi.services.extractor import Extractor, PausableExtractor
from nodes.action.naoqi.services.module import kept


class ALFaceDetection(PausableExtractor):
    """Sees faces, and names those of people that it was told."""

    events = ("FaceDetected",)
    set_recognition, recognition = kept(
        "setRecognitionEnabled::v(b)", "isRecognitionEnabled::b()", True
    )
    set_tracking, tracking = kept("setTrackingEnabled::v(b)", "isTrackingEnabled::b()", False)

    @method("learnFace::b(s)")
    def learn_face(self, name: str) -> Any:
        """Learn the face in front of it."""
        return self._do("learn_face", True, name=name)

    @method("reLearnFace::b(s)")
    def relearn_face(self, name: str) -> Any:
        """Learn the face in front of it once more."""
        return self._do("learn_face", True, name=name)

    @method("forgetPerson::b(s)")
    def forget_person(self, name: str) -> Any:
        """Forget a face."""
        return self._do("forget_face", True, name=name)

    @method("clearDatabase::b()")
    def clear_database(self) -> bool:
        """Forget all faces that it has learnt."""
        with self._robot.lock:
            forget_all_faces(self._robot.robot)
        return True

    @method("getLearnedFacesList::m()")
    def learned_faces(self) -> list[str]:
        """Return the names of the faces that it has learnt."""
        with self._robot.lock:
            return list(self._robot.robot.faces.learnt.values())


class ALLandMarkDetection(PausableExtractor):
    """Sees the round marks that NAO knows by their numbers."""

    events = ("LandmarkDetected",)


class ALRedBallDetection(Extractor):
    """Sees the red ball."""

    events = ("redBallDetected",)


class ALSoundLocalization(PausableExtractor):
    """Hears where a sound comes from."""

    events = ("ALSoundLocalization/SoundLocated",)

    @method("setParameter::v(sm)")
    def set_parameter(self, name: str, value: Any) -> None:
        """Remember how well it hears: Sensitivity (0 to 1) or EnergyComputation."""
        if name not in ("Sensitivity", "Sensibility", "EnergyComputation"):
            raise CallFailed(f"There is no parameter “{name}”. Possible: Sensitivity.")
        self._kept[name] = value


class ALSonar(Extractor):
    """Measures how far things in front of it are."""

    events = (
        "SonarLeftDetected",
        "SonarRightDetected",
        "SonarLeftNothingDetected",
        "SonarRightNothingDetected",
    )

    @method("getFilteredValues::[f]()")
    def filtered_values(self) -> list[float]:
        """Return the distances on the left and on the right, m."""
        sensors = self._robot.state().sensors
        return [sensors.get(f"sonar_{side}", SONAR_RANGE_M) for side in ("left", "right")]
