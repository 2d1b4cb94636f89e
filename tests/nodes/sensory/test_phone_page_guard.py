"""Who may talk to the phone page, by what the browser says."""

import pytest

from nodes.sensory.phone_page.server import page_urls
from nodes.sensory.phone_page.site import headers, is_our_host, is_our_origin, is_token, new_token


@pytest.mark.parametrize(
    ("host", "own", "is_ours"),
    [
        ("192.168.1.7:8443", ("192.168.1.7", 8443), True),
        ("192.168.1.7", ("192.168.1.7", 443), True),
        ("192.168.1.7", ("192.168.1.7", 8443), False),
        ("localhost:8443", ("127.0.0.1", 8443), True),
        ("localhost:8443", ("192.168.1.7", 8443), False),
        ("192.168.1.8:8443", ("192.168.1.7", 8443), False),
    ],
)
def test_only_the_address_that_was_called_is_ours(host, own, is_ours):
    assert is_our_host(host, own) is is_ours


def test_the_links_name_every_address_of_this_computer():
    links = page_urls(8443, "abc", ["192.168.1.7", "10.0.0.2"])

    assert links == ["https://192.168.1.7:8443/abc/", "https://10.0.0.2:8443/abc/"]


def test_only_our_own_page_may_send():
    assert is_our_origin({"Origin": "https://192.168.1.7:8443"}, "192.168.1.7:8443")
    assert not is_our_origin({"Origin": "http://192.168.1.7:8443"}, "192.168.1.7:8443")
    assert not is_our_origin({}, "192.168.1.7:8443")


def test_the_page_of_refusal_may_have_its_one_style():
    policy = headers("192.168.1.7:8443", "abc")["Content-Security-Policy"]

    assert "style-src 'nonce-abc';" in policy


@pytest.mark.parametrize("given", ["", "abd", "ab", "abcd", "äöü", "\x00"])
def test_no_other_word_is_the_token(given):
    assert is_token("abc", "abc")
    assert not is_token(given, "abc")
    assert not is_token(given, "")


def test_no_two_tokens_are_the_same():
    assert len({new_token() for _ in range(100)}) == 100
