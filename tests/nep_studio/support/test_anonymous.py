"""A report tells nothing of who somebody is, and keeps what helps."""

from __future__ import annotations

import pytest

from nep_studio.support.anonymous import Anonymous

ANNA = Anonymous(
    "/HOME/anna", ("anna", "Anna Schmidt", "Schmidt"), "annas-laptop.school.example", ("hunter22",)
)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("/HOME/anna/Documents/dance.nep", "~/Documents/<file>.nep"),
        ("/HOME/anna", "~"),
        ("/HOME/annabel/x", "/HOME/<user>/x"),
        (r"C:\USERS\Bob\AppData", r"C:\USERS\<user>\AppData"),
        (r"C:\\USERS\\BOBSMI~1\\x", r"C:\\USERS\\<user>\\x"),
        ("file:///HOME/j%C3%B6rg/a.nep", "file:///HOME/<user>/<file>.nep"),
        ("/run/media/ANNA/STICK", "/run/media/<folder>/STICK"),
        ("Anna_Schmidt's banana", "<user>_<user>'s banana"),
        ("host annas-laptop: ANNAS-LAPTOP.school.example", "host <computer>: <computer>"),
        ("he typed hunter22.", "he typed <hidden>."),
        ('{"password": "x y", "user": 1}', '{"password": <hidden>, "user": 1}'),
        ("NEP_ROBOT_PASSWORD=abc;next", "NEP_ROBOT_PASSWORD=<hidden>;next"),
        ("tcp://nao:secret@192.168.1.10:9559", "tcp://<hidden>@192.168.1.10:9559"),
        (
            "https://192.168.1.5:8443/AbCdEf012345_-x/page",
            "https://192.168.1.5:8443/<hidden>/page",
        ),
        ("GET /?key=abc&x=1", "GET /?key=<hidden>&x=1"),
        ("write to anna@school.example now", "write to <address of a person> now"),
        ("at 00:1b:44:11:3a:b7 and", "at <hidden> and"),
        ("fe80::21b:44ff:fe11:3ab7", "fe80::<hidden>"),
        ("from 8.8.8.8, 192.168.1.7 and 127.0.0.1", "from <hidden>, 192.168.1.7 and 127.0.0.1"),
        ("tcp://8.8.8.8:7000, IP:8.8.4.4", "tcp://<hidden>:7000, IP:<hidden>"),
        ("::ffff:8.8.8.8 and [2003:e1::5]:80", "::ffff:<hidden> and [<hidden>]:80"),
        ("the driver 31.0.15.3623", "the driver 31.0.15.3623"),
        (
            "https://10.1.1.5:8443/AbCdEf012345 is open",
            "https://10.1.1.5:8443/<hidden> is open",
        ),
        ("pairing code: 482 915", "pairing code: <hidden>"),
        ("ended with code 3221225477", "ended with code 3221225477"),
        ("ssid=Schmidts, Bearer abc.def", "ssid=<hidden>, Bearer <hidden>"),
        ("bobs-nao.local:9559", "<computer>.local:9559"),
        (r"at \\SERVER4\class\x", r"at \\<computer>\class\x"),
        (r"C:\USERS\Bob Smith\x", r"C:\USERS\<user>\x"),
        ("/HOME/anna/Clinic/case 4/a b.csv", "~/<folder>/<folder>/<file>.csv"),
        (r"E:\Class 4b\nep-studio\x.log", r"E:\<folder>\nep-studio\x.log"),
        ('"/HOME/anna/src/nep_studio/ui/x.py", line 3', '"~/<folder>/nep_studio/ui/x.py", line 3'),
        ("“Anna in hospital.nep” is damaged", "“<file>.nep” is damaged"),
        ("\x1b[31mred \udcff", "?[31mred ?"),
        ("-----BEGIN PRIVATE KEY-----\nMII\n-----END PRIVATE KEY-----\nend", "<hidden>\nend"),
        ("-----BEGIN PRIVATE KEY-----\nMII", "<hidden>"),
        ("NEP_NAOQI_LOGIN=nao:s3cret next", "NEP_NAOQI_LOGIN=<hidden> next"),
        ("key @z5mXRefKArmQ-H?9N&Uj?t=j3xUG>!-yC1FF8/X", "key <hidden>"),
        ("peer Yne5mXRefKArmQ7H49N1Uj2t3j3xUGa5yC1FF8dX", "peer <hidden>"),
        (
            "Authorization: Basic bmFv, --token AbC1",
            "Authorization: Basic <hidden> --token <hidden>",
        ),
        ("Kopplungscode 482 915, psk=abc", "Kopplungscode <hidden>, psk=<hidden>"),
        ("'NEP_NAOQI_LOGIN': 'nao:s 3'", "'NEP_NAOQI_LOGIN': <hidden>"),
        ("phone_token=AbC-123", "phone_token=<hidden>"),
        ("  nep pair 482915", "  nep pair <hidden>"),
        ("  nep pair 192.168.1.5:7105 482 915", "  nep pair 192.168.1.5:7105 <hidden>"),
        ("Paired with the laptop by 482-915.", "Paired with the laptop by <hidden>."),
        ("Der Code ist 482 915", "Der Code ist <hidden>"),
        ("\n482 915\n", "\n<hidden>\n"),
        ("rq:rM>}U?@Lns47E1%kR.o@n%FcmmsL/@{H8]yf7", "<hidden>"),
        ("key=rq:rM>}U?@Lns47E1%kR.o@n%FcmmsL/@{H8]yf7.", "key=<hidden>."),
        ('"rq:rM>}U?@Lns47E1%kR.o@n%FcmmsL/@{H8]yf7"', '"<hidden>"'),
        (
            "/usr/lib/python3.11/site-packages/zmq_x.py",
            "/usr/lib/python3.11/site-packages/zmq_x.py",
        ),
        ("spin: 3, 100 200 samples", "spin: 3, 100 200 samples"),
        ("OpenGL 4.6, Qt 6.11.3 at 12:30:45", "OpenGL 4.6, Qt 6.11.3 at 12:30:45"),
    ],
)
def test_a_text_is_without_names_and_secrets(text: str, told: str) -> None:
    assert ANNA.text(text) == told


def test_a_home_of_windows_is_found_however_its_slashes_are_written() -> None:
    person = Anonymous(r"C:\USERS\Anna Smith", ("Anna Smith",), "PC")

    told = [
        person.text(text)
        for text in (r"c:\users\anna smith\x", "C:/Users/Anna Smith/x", r"C:\\USERS\\Anna Smith\\x")
    ]

    assert told == [r"~\x", "~/x", r"~\\x"]


@pytest.mark.parametrize("written", ["J\u00f6rg", "Jo\u0308rg", "J%C3%B6rg", "J\\u00f6rg"])
def test_a_name_is_found_however_its_letters_are_written(written: str) -> None:
    assert Anonymous(names=("Jo\u0308rg",)).text(f"by {written} now") == "by <user> now"


def test_a_name_of_two_signs_is_found_where_words_have_no_space_between_them() -> None:
    assert Anonymous(names=("健太", "Li")).text("健太さん likes Linux") == "<user>さん likes Linux"


def test_a_person_called_like_a_part_of_the_program_changes_no_words() -> None:
    person = Anonymous("/HOME/nao", ("nao",), "nao")

    assert person.text("the node nao in /HOME/nao/logs") == "the node nao in ~/logs"


def test_what_is_known_of_this_computer_can_be_taken_out() -> None:
    here = Anonymous.here(["a secret"])

    assert here.text("a secret") == "<hidden>"
    assert here.home
