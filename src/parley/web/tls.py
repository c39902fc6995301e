"""A certificate of our own, where nobody gave one: browsers warn once, the connection is sealed anyway."""

from __future__ import annotations

import datetime
import ipaddress
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from parley.errors import ConfigError

if TYPE_CHECKING:
    from cryptography import x509

__all__ = ["fingerprint", "made_certificate"]

VALID_DAYS: Final = 397
"""The longest that browsers accept."""
RENEW_DAYS: Final = 30


def made_certificate(folder: Path, names: Sequence[str], unix_ms: int) -> tuple[Path, Path]:
    """A certificate for these names, made at the first use and when the old one does not fit any more.

    Args:
        folder: Where it is kept.
        names: Host names and addresses.
        unix_ms: Now.

    Returns:
        The files of the certificate and of its key.

    Raises:
        ConfigError: They cannot be written.
    """
    certificate, key = folder / "certificate.pem", folder / "key.pem"
    if not _fits(certificate, key, names, unix_ms):
        try:
            folder.mkdir(parents=True, exist_ok=True)
            _make(certificate, key, names, unix_ms)
        except OSError as error:
            raise ConfigError(f"the certificate cannot be written to {folder}: {error}") from error
    return certificate, key


def fingerprint(certificate: Path) -> str:
    """The certificate's SHA-256 fingerprint, for people to compare with what their browser shows."""
    from cryptography import x509
    from cryptography.hazmat.primitives import hashes

    digest = x509.load_pem_x509_certificate(certificate.read_bytes()).fingerprint(hashes.SHA256())
    return ":".join(f"{byte:02X}" for byte in digest)


def _fits(certificate: Path, key: Path, names: Sequence[str], unix_ms: int) -> bool:
    from cryptography import x509

    try:
        found = x509.load_pem_x509_certificate(certificate.read_bytes())
        listed = found.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except (OSError, ValueError, x509.ExtensionNotFound):
        return False
    covered = {str(item.value) for item in listed}
    soon = datetime.datetime.fromtimestamp(unix_ms / 1000, datetime.UTC) + datetime.timedelta(days=RENEW_DAYS)
    return key.is_file() and set(names) <= covered and found.not_valid_after_utc > soon


def _make(certificate: Path, key: Path, names: Sequence[str], unix_ms: int) -> None:
    from cryptography import x509
    from cryptography.hazmat.primitives import hashes, serialization
    from cryptography.hazmat.primitives.asymmetric import ec
    from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

    private = ec.generate_private_key(ec.SECP256R1())
    subject = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "Parley")])
    now = datetime.datetime.fromtimestamp(unix_ms / 1000, datetime.UTC)
    built = (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(subject)
        .public_key(private.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - datetime.timedelta(days=1))
        .not_valid_after(now + datetime.timedelta(days=VALID_DAYS))
        .add_extension(x509.SubjectAlternativeName([_name(name) for name in names]), critical=False)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH]), critical=False)
        .sign(private, hashes.SHA256())
    )
    secret = private.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    key.unlink(missing_ok=True)
    with os.fdopen(os.open(key, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as file:
        file.write(secret)
    certificate.write_bytes(built.public_bytes(serialization.Encoding.PEM))


def _name(name: str) -> x509.GeneralName:
    from cryptography import x509

    try:
        return x509.IPAddress(ipaddress.ip_address(name))
    except ValueError:
        return x509.DNSName(name)
