"""The phone page, served for the tests of its server."""

import contextlib

import pytest

from nodes.sensory.connectors.connector import Settings
from nodes.sensory.phone_page.server import PhonePage
from tests.nodes.sensory.page_client import (
    TOKEN,
    finish,
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("certificate")


@pytest.fixture(scope="module", autouse=True)
def client():
    yield
    finish()


@contextlib.contextmanager
def served(folder, port=0, token=TOKEN):
    page = PhonePage(Settings(port=port, token=token), folder / "nep-studio")
    page.open()
    yield page
    page.close()


@pytest.fixture(scope="module")
def shared_page(folder):
    with served(folder) as page:
        yield page


@pytest.fixture
def page(shared_page):
    """The page, with nothing in it from the test before."""
    shared_page.readings()
    return shared_page


@pytest.fixture
def own_page(folder):
    """A page of this test alone."""
    with served(folder) as page:
        yield page
