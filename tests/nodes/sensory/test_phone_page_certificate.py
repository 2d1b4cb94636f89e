"""The certificate of the phone page, and the addresses that it is for."""

import os
import socket
import ssl
import stat
import sys
from datetime import UTC, datetime, timedelta
from types import SimpleNamespace

import pytest
from cryptography import x509

from nodes.sensory.connectors import servers as addresses
from nodes.sensory.phone_page import server
from nodes.sensory.phone_page.server import own_certificate


def content(made):
    return x509.load_pem_x509_certificate(made.path.read_bytes())


def test_it_is_good_for_this_computer_and_its_addresses(tmp_path):
    made = own_certificate(["192.168.1.7"], tmp_path)

    names = content(made).extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    assert names.get_values_for_type(x509.DNSName) == ["localhost"]
    found = [str(address) for address in names.get_values_for_type(x509.IPAddress)]
    assert found == ["127.0.0.1", "192.168.1.7"]
    assert made.context().minimum_version >= ssl.TLSVersion.TLSv1_2


def test_it_is_valid_now_and_not_longer_than_browsers_accept(tmp_path):
    found = content(own_certificate([], tmp_path))

    now = datetime.now(UTC)
    assert found.not_valid_before_utc < now < found.not_valid_after_utc
    assert found.not_valid_after_utc - found.not_valid_before_utc < timedelta(days=398)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows keeps rights in another way")
def test_only_this_user_may_read_the_key(tmp_path):
    old_mask = os.umask(0)
    try:
        made = own_certificate([], tmp_path / "new folder")
    finally:
        os.umask(old_mask)

    assert stat.S_IMODE(made.path.stat().st_mode) == 0o600
    assert list(made.path.parent.iterdir()) == [made.path]


def test_it_is_kept_while_the_addresses_are_the_same_or_fewer(tmp_path):
    first = own_certificate(["192.168.1.7", "10.0.0.2"], tmp_path)

    again, fewer = (own_certificate(["192.168.1.7"], tmp_path) for _ in range(2))

    assert first.spki_sha256 == again.spki_sha256 == fewer.spki_sha256


def test_a_new_address_makes_a_new_one_that_is_good_for_the_old_address_too(tmp_path):
    first = own_certificate(["192.168.1.7"], tmp_path).spki_sha256

    second = own_certificate(["10.0.0.2"], tmp_path)
    back = own_certificate(["192.168.1.7"], tmp_path)

    assert second.spki_sha256 != first
    assert back.spki_sha256 == second.spki_sha256


def test_one_that_ends_soon_is_made_anew(tmp_path, monkeypatch):
    monkeypatch.setattr(server, "VALID_DAYS", 10)
    first = own_certificate([], tmp_path).spki_sha256
    monkeypatch.setattr(server, "VALID_DAYS", 397)

    second = own_certificate([], tmp_path).spki_sha256

    assert first != second


@pytest.mark.parametrize("half", ["PRIVATE KEY", "CERTIFICATE", "nothing of this"])
def test_a_broken_file_is_made_anew(tmp_path, half):
    path = own_certificate([], tmp_path).path
    path.write_text(path.read_text().replace(half, "") if half in path.read_text() else "")

    made = own_certificate([], tmp_path)

    assert made.context()


def test_addresses_are_reachable_ones_and_the_one_of_the_default_route_goes_first(monkeypatch):
    found = {
        "lo": "127.0.0.1",
        "docker0": "172.17.0.1",
        "eth0": "93.184.216.34",
        "eth1": "169.254.3.4",
        "wlan0": "192.168.1.7",
        "wlan1": "10.0.0.2",
        "off0": "192.168.9.9",
    }
    cards = {
        name: [SimpleNamespace(family=socket.AF_INET, address=address)]
        for name, address in found.items()
    }
    states = {name: SimpleNamespace(isup=name != "off0") for name in found}
    monkeypatch.setattr(addresses.psutil, "net_if_addrs", lambda: cards)
    monkeypatch.setattr(addresses.psutil, "net_if_stats", lambda: states)
    monkeypatch.setattr(addresses, "_main_address", lambda: "10.0.0.2")

    ordered = addresses.lan_addresses()

    assert ordered == ["10.0.0.2", "192.168.1.7", "93.184.216.34", "172.17.0.1"]


def test_this_computers_own_addresses_can_be_listed():
    assert all(not address.startswith("127.") for address in addresses.lan_addresses())
