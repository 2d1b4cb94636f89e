"""The certificate of the phone page: made on this computer, for this computer, kept for a year."""

from __future__ import annotations

import contextlib
import ipaddress
import os
import ssl
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING

import platformdirs

from nep_core.places import portable_folder

if TYPE_CHECKING:
    from cryptography import x509

FILE = "phone_page.pem"
VALID_DAYS = 397  # browsers refuse certificates that are good for longer than 398 days
RENEWED_BEFORE = timedelta(days=14)
_CLOCKS_DIFFER = timedelta(days=1)
_MOST_NAMES = 16
_OWNER_ONLY = 0o600


@dataclass(frozen=True)
class Certificate:
    """The file of a key and its certificate, which is good for ``names``."""

    path: Path
    names: tuple[str, ...]

    def context(self) -> ssl.SSLContext:
        """What a server needs to speak TLS 1.2 or newer with it."""
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.minimum_version = ssl.TLSVersion.TLSv1_2
        context.load_cert_chain(self.path)
        return context

    @property
    def spki_sha256(self) -> str:
        """The fingerprint of its public key in base64, as browsers write it."""
        import base64
        import hashlib

        from cryptography import x509
        from cryptography.hazmat.primitives import serialization

        public = x509.load_pem_x509_certificate(self.path.read_bytes()).public_key()
        der = public.public_bytes(
            serialization.Encoding.DER, serialization.PublicFormat.SubjectPublicKeyInfo
        )
        return base64.b64encode(hashlib.sha256(der).digest()).decode()


def certificate_folder() -> Path:
    """Where the key is kept: among this user's settings."""
    if folder := portable_folder():
        return folder / "keys"
    try:
        return Path(platformdirs.user_config_dir("nep-studio", appauthor=False))
    except RuntimeError:  # a user without a home
        return Path(tempfile.gettempdir()) / "nep-studio"


def own_certificate(addresses: Sequence[str], folder: Path | None = None) -> Certificate:
    """The kept certificate, or a new one when that is not good for all addresses or gets too old.

    Earlier addresses stay in a new one, so that going back to a network does not make the phone
    ask again. Raises OSError when it cannot be kept.
    """
    folder = folder or certificate_folder()
    wanted = ("localhost", "127.0.0.1", *addresses)
    path = folder / FILE
    kept = _kept_names(path)
    if kept and set(wanted) <= set(kept):
        return Certificate(path, kept)
    folder.mkdir(parents=True, exist_ok=True)
    names = tuple(dict.fromkeys((*wanted, *kept)))[:_MOST_NAMES]
    _make(path, names)
    return Certificate(path, names)


def _kept_names(path: Path) -> tuple[str, ...]:
    """The names that the kept certificate is good for, none when it cannot be used any more."""
    from cryptography import x509

    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(path)
        found = x509.load_pem_x509_certificate(path.read_bytes())
        names = found.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except (OSError, ValueError, x509.ExtensionNotFound):
        return ()
    now = datetime.now(UTC)
    if not found.not_valid_before_utc <= now < found.not_valid_after_utc - RENEWED_BEFORE:
        return ()
    return tuple(str(name.value) for name in names)


def _make(path: Path, names: Sequence[str]) -> None:
    from cryptography import x509
    from cryptography.hazmat.primitives import hashes, serialization
    from cryptography.hazmat.primitives.asymmetric import ec
    from cryptography.x509.oid import ExtendedKeyUsageOID

    key = ec.generate_private_key(ec.SECP256R1())
    subject = x509.Name(
        [x509.NameAttribute(x509.NameOID.COMMON_NAME, "NEP Studio on this computer")]
    )
    now = datetime.now(UTC)
    number = x509.random_serial_number()
    builder = x509.CertificateBuilder(subject, subject, key.public_key(), number)
    builder = builder.not_valid_before(now - _CLOCKS_DIFFER)
    builder = builder.not_valid_after(now - _CLOCKS_DIFFER + timedelta(days=VALID_DAYS))
    alternatives = x509.SubjectAlternativeName([_general_name(name) for name in names])
    usage = x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH])
    builder = builder.add_extension(alternatives, critical=False)
    builder = builder.add_extension(usage, critical=False)
    builder = builder.add_extension(x509.BasicConstraints(False, None), critical=True)
    pem = serialization.Encoding.PEM
    private = key.private_bytes(
        pem, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    _write(path, private + builder.sign(key, hashes.SHA256()).public_bytes(pem))


def _general_name(name: str) -> x509.GeneralName:
    from cryptography import x509

    try:
        return x509.IPAddress(ipaddress.ip_address(name))
    except ValueError:
        return x509.DNSName(name)


def _write(path: Path, content: bytes) -> None:
    """Write a file that only this user may read, at no moment another."""
    number, name = tempfile.mkstemp(dir=path.parent, prefix=path.name)  # is made with 0600
    try:
        with os.fdopen(number, "wb") as file:
            file.write(content)
        Path(name).chmod(_OWNER_ONLY)
        Path(name).replace(path)
    except BaseException:
        with contextlib.suppress(OSError):
            Path(name).unlink()
        raise
