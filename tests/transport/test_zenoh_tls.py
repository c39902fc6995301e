"""Encryption: who has a certificate of our authority is heard, and nobody else gets in."""

from __future__ import annotations

import asyncio
import datetime
import ipaddress
import re
import ssl
from pathlib import Path

import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from pydantic import ValidationError

from parley.config import NetworkSettings, TlsSettings
from parley.door_check import examine_door
from parley.messages.ros import String
from parley.transport.zenoh import ZenohTransport
from tests.transport.backends import free_port, until
from tests.transport.peer import TALK

Signed = tuple[x509.Certificate, ec.EllipticCurvePrivateKey]
LONG_AGO = datetime.datetime(2020, 1, 1, tzinfo=datetime.UTC)


def signed(name: str, by: Signed | None = None, *, days: int = 36500) -> Signed:
    """A certificate, by itself that of an authority."""
    key = ec.generate_private_key(ec.SECP256R1())
    subject = x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, name)])
    here = [x509.DNSName("localhost"), x509.IPAddress(ipaddress.ip_address("127.0.0.1"))]
    builder = (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(by[0].subject if by else subject)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(LONG_AGO)
        .not_valid_after(LONG_AGO + datetime.timedelta(days=days))
        .add_extension(x509.BasicConstraints(ca=by is None, path_length=None), critical=True)
        .add_extension(x509.SubjectAlternativeName(here), critical=False)
    )
    return builder.sign(by[1] if by else key, hashes.SHA256()), key


def files(folder: Path, name: str, own: Signed, authority: Signed) -> TlsSettings:
    made = TlsSettings(
        authority=folder / f"{name}.ca.pem", certificate=folder / f"{name}.pem", key=folder / f"{name}.key"
    )
    made.authority.write_bytes(authority[0].public_bytes(serialization.Encoding.PEM))
    made.certificate.write_bytes(own[0].public_bytes(serialization.Encoding.PEM))
    made.key.write_bytes(
        own[1].private_bytes(
            serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
        )
    )
    return made


async def handshake(port: int, settings: TlsSettings, *, shows: bool) -> None:
    """Knock as somebody who trusts the authority, with a certificate or without."""
    context = ssl.create_default_context(cafile=settings.authority)
    if shows:
        context.load_cert_chain(settings.certificate, settings.key)
    reader, writer = await asyncio.open_connection("127.0.0.1", port, ssl=context)
    try:
        await reader.read(1)
    finally:
        writer.close()


async def test_only_who_has_a_certificate_of_the_authority_gets_in(tmp_path: Path) -> None:
    authority, other = signed("authority"), signed("another authority")
    ours = files(tmp_path, "ours", signed("robots", authority), authority)
    theirs = files(tmp_path, "theirs", signed("page", authority), authority)
    foreign = files(tmp_path, "foreign", signed("foreign", other), authority)
    port = free_port()
    at = (f"tls/127.0.0.1:{port}",)
    heard: list[String] = []
    async with (
        ZenohTransport(NetworkSettings(listen=at, interface="", tls=ours)) as here,
        ZenohTransport(NetworkSettings(listen=(), connect=at, interface="", tls=theirs)) as there,
    ):
        await there.subscribe(TALK, heard.append)
        await until(lambda: here.endpoints())
        here.publisher(TALK).publish(String("secret"))
        await until(lambda: heard)
        for stranger, shows in ((theirs, False), (foreign, True)):
            with pytest.raises((ssl.SSLError, ConnectionResetError)):
                await handshake(port, stranger, shows=shows)


async def test_the_doctor_says_whose_certificate_is_wrong_and_what_is_to_be_done(tmp_path: Path) -> None:
    authority, other = signed("authority"), signed("another authority")
    ours = files(tmp_path, "ours", signed("robots", authority), authority)
    late = files(tmp_path, "late", signed("robots", authority, days=1), authority)
    good = files(tmp_path, "good", signed("page", authority), authority)
    foreign = files(tmp_path, "foreign", signed("page", other), authority)
    odd = good.model_copy(update={"key": foreign.key})
    away = good.model_copy(update={"certificate": tmp_path / "nowhere"})
    ports = [free_port() for _ in range(3)]
    told: list[str] = []

    def door(port: int, tls: TlsSettings | None) -> NetworkSettings:
        at = f"{'tls' if tls else 'tcp'}/127.0.0.1:{port}"
        return NetworkSettings(role="client", connect=(at,), listen=(), interface="", tls=tls)

    async with (
        ZenohTransport(NetworkSettings(listen=(f"tls/127.0.0.1:{ports[0]}",), interface="", tls=ours)),
        ZenohTransport(NetworkSettings(listen=(f"tls/127.0.0.1:{ports[1]}",), interface="", tls=late)),
        ZenohTransport(NetworkSettings(listen=(f"tcp/127.0.0.1:{ports[2]}",), interface="")),
    ):
        for port, tls in (
            (0, good), (0, foreign), (0, odd), (0, away), (0, None), (1, good), (2, good), (2, None),
        ):  # fmt: skip
            network = door(ports[port], tls)
            found = await asyncio.to_thread(examine_door, network.connect[0], network)
            told.append(f"{found.text} {found.remedy}")
    for text, expected in zip(
        told,
        ("answers $", "does not take this machine's certificate .* by their authority", "does not belong",
         "cannot be read: .*nowhere", "encrypted only .* of both", "expired .* clocks", "not encrypted",
         "answers $"),
        strict=True,
    ):  # fmt: skip
        assert re.search(expected, text), (text, expected)


def test_an_address_that_would_not_be_encrypted_is_refused(tmp_path: Path) -> None:
    tls = {"authority": tmp_path / "a", "certificate": tmp_path / "b", "key": tmp_path / "c"}
    with pytest.raises(ValidationError, match=r"tcp/0\.0\.0\.0:7447 should begin with tls/"):
        NetworkSettings.model_validate({"tls": tls, "listen": ["tcp/0.0.0.0:7447"]})
    with pytest.raises(ValidationError, match="tls/robot:7447 should begin with tcp/"):
        NetworkSettings.model_validate({"connect": ["tls/robot:7447"]})
    assert NetworkSettings.model_validate({"tls": tls}).listens == ("tls/127.0.0.1:0",)
