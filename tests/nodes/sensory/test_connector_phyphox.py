"""phyphox on a phone is asked what is new, whatever its buffers are called."""

import http.server
import json
import threading
from contextlib import contextmanager

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_core.errors import ParameterError
from nodes.sensory.connectors.phyphox import read_answer, read_config
from nodes.sensory.connectors.servers import phone_address
from tests.nodes.sensory.connector_hearing import assert_same, free_port, opened, turned
from tests.nodes.sensory.phones import NAMES, PhyphoxPhone

OTHER_NAMES = {
    "accelerometer": ("t", "x axis", "y", "z|raw"),
    "gyroscope": ("gyroT", "wx", "wy", "wz"),
}


def of(phone, **given):
    return opened("phyphox", address=f"http://127.0.0.1:{phone.port}/", **given)


@pytest.mark.parametrize("names", [NAMES, OTHER_NAMES])
def test_the_phones_movement_is_heard_whatever_its_buffers_are_called(names):
    recording = turned(3.0)
    with PhyphoxPhone(recording, names=names) as phone, of(phone) as heard:
        heard.until(lambda: len(heard.readings) >= 60)

    start = round(heard.readings[0].stamp * 100)
    later = turned(3.0)
    later = type(later)(
        "", later.t[start:], later.acc[start:], later.gyr[start:], None, True
    )  # it is heard from the moment on that it was asked
    assert_same(heard.readings, later)
    assert phone.asked[:3] == ["/config", "/get", "/control"]
    assert heard.columns == "accelerometer + gyroscope"
    assert heard.troubles == ""


def test_an_experiment_without_gyroscope_is_heard():
    names = {"accelerometer": NAMES["accelerometer"]}
    with PhyphoxPhone(turned(2.0), names=names) as phone, of(phone, units="apple") as heard:
        heard.until(lambda: len(heard.readings) >= 10)

    assert heard.readings[0].gyr is None
    assert heard.readings[0].acc[2] < 0


def test_an_experiment_without_accelerometer_is_told():
    with PhyphoxPhone(turned(), names={}) as phone:
        phone.title = "Magnetic ruler"
        with of(phone) as heard:
            heard.until(lambda: heard.troubles)

    assert "“Magnetic ruler”, which has no accelerometer" in heard.troubles


def test_a_phone_that_was_away_is_found_again():
    port = free_port()
    with opened("phyphox", address="127.0.0.1", port=port) as heard:
        heard.until(lambda: "does not answer" in heard.troubles)
        phone = PhyphoxPhone(turned(3.0))
        heard.connector._port = phone.port
        with phone:
            heard.until(lambda: len(heard.readings) >= 10)


def test_an_experiment_that_is_paused_is_told():
    with PhyphoxPhone(turned(4.0)) as phone, of(phone) as heard:
        heard.until(lambda: heard.readings)
        phone.pause()
        heard.until(lambda: "is paused" in heard.troubles)

    assert phone.asked.count("/control") == 1


def test_another_experiment_is_read_anew():
    with PhyphoxPhone(turned(4.0)) as phone, of(phone) as heard:
        heard.until(lambda: heard.readings)
        phone.session, phone.names = "another", OTHER_NAMES
        before = len(heard.readings)
        heard.until(lambda: len(heard.readings) >= before + 10)

    assert phone.asked.count("/config") == 2


@contextmanager
def web_server(answer):
    """A web server that answers everything alike."""

    class Answers(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            try:
                self.send_response(200)
                self.end_headers()
                self.wfile.write(answer)
            except OSError:
                pass  # it was cut off

        def log_message(self, *_args):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Answers)
    server.daemon_threads = True
    thread = threading.Thread(target=server.serve_forever, args=(0.02,))
    thread.start()
    try:
        yield server.server_address[1]
    finally:
        server.shutdown()
        server.server_close()
        thread.join()


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (b"<html>a printer</html>", "is not phyphox"),
        (b"{}", "no accelerometer"),
        (b"[" * 100_000, "is not phyphox"),
        (b'{"buffer": "\xff"}', "is not phyphox"),
        (b"1" * 5_000, "is not phyphox"),
        (b" " * 6_000_000, "does not answer"),
    ],
)
def test_what_is_no_phyphox_is_told(answer, words):
    with web_server(answer) as port, opened("phyphox", address=f"127.0.0.1:{port}") as heard:
        heard.until(lambda: words in heard.troubles)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("192.168.1.20", ("192.168.1.20", 8080)),
        (" 192.168.1.20:80 ", ("192.168.1.20", 80)),
        ("http://192.168.1.20:8080/config", ("192.168.1.20", 8080)),
        ("my-phone.local", ("my-phone.local", 8080)),
        ("[fe80::1]:8081", ("[fe80::1]", 8081)),
    ],
)
def test_addresses_of_phones(text, found):
    assert phone_address(text, 8080, "phyphox") == found


@pytest.mark.parametrize("text", ["", "my phone", "192.168.1.20:99999", "a@b", "x" + chr(10)])
def test_what_is_no_address_is_refused_with_what_to_do(text):
    with pytest.raises(ParameterError) as told:
        phone_address(text + " ?" * bool(text.strip() == "x"), 8080, "phyphox")

    assert told.value.checklist


values = st.recursive(
    st.none() | st.floats() | st.text(max_size=3) | st.sampled_from(["full", "partial"]),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.sampled_from(["buffer", "acc_time", "accX", "updateMode"]), inner)
    ),
    max_leaves=10,
)


@given(values, values)
def test_no_answer_crashes_the_reader(config, answer):
    usual = {"buffers": [{"name": name} for names in NAMES.values() for name in names]}
    read_config(json.dumps({"inputs": config, "buffers": config}).encode())
    experiment = read_config(json.dumps(usual).encode())

    read = read_answer(json.dumps({"buffer": answer, "status": config}).encode())

    assert experiment.acc is not None
    for _ in range(3 if read else 0):
        assert isinstance(experiment.take(read, is_apple=False), list)
