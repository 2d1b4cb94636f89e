"""SensorServer on a phone: a WebSocket for both sensors, or for those that it has."""

import pytest

from nep_core.errors import ParameterError
from tests.nodes.sensory.connector_hearing import free_port, opened, turned
from tests.nodes.sensory.phones import SensorServerPhone


def of(phone):
    return opened("sensor_server", address="127.0.0.1", port=phone.port)


def accelerations(heard):
    return [reading.acc for reading in heard.readings if reading.acc is not None]


def rotations(heard):
    return [reading.gyr for reading in heard.readings if reading.gyr is not None]


def test_both_sensors_come_over_one_connection():
    recording = turned(1.0)
    with SensorServerPhone(recording) as phone, of(phone) as heard:
        heard.until(lambda: len(heard.readings) >= 100)

    acc = accelerations(heard)
    assert acc == [pytest.approx(tuple(row)) for row in recording.acc[: len(acc)].tolist()]
    assert rotations(heard)[10] == pytest.approx(recording.gyr[10])
    assert phone.paths == ["/sensors/connect"]
    assert heard.troubles == ""


def test_a_phone_without_gyroscope_sends_its_accelerometer():
    with SensorServerPhone(turned(), sensors=("accelerometer",)) as phone, of(phone) as heard:
        heard.until(lambda: len(accelerations(heard)) >= 20)

    assert rotations(heard) == []


def test_an_older_app_is_asked_for_each_sensor():
    with SensorServerPhone(turned(), knows_many=False) as phone, of(phone) as heard:
        heard.until(lambda: len(accelerations(heard)) >= 20 and len(rotations(heard)) >= 20)

    assert phone.paths[0] == "/sensors/connect"
    assert set(phone.paths[1:3]) == {"/sensor/connect"}


def test_a_phone_without_accelerometer_is_told():
    with SensorServerPhone(turned(), sensors=("gyroscope",)) as phone, of(phone) as heard:
        heard.until(lambda: "has no accelerometer" in heard.troubles)


def test_a_server_that_is_not_started_is_told_and_found_later():
    with opened("sensor_server", address="127.0.0.1", port=free_port()) as heard:
        heard.until(lambda: "does not answer" in heard.troubles)
        with SensorServerPhone(turned()) as phone:
            heard.connector._port = phone.port
            heard.until(lambda: accelerations(heard))


def test_a_connection_that_ends_is_told_and_made_anew():
    with SensorServerPhone(turned(0.1)) as phone, of(phone) as heard:
        heard.until(lambda: "ended the connection" in heard.troubles)
        heard.until(lambda: len(phone.paths) >= 2)


def test_a_missing_address_is_told():
    with pytest.raises(ParameterError, match="missing"), opened("sensor_server"):
        pass
