"""What `parley doctor` finds where the settings connect to: nobody, somebody else, or a closed door."""

from __future__ import annotations

import contextlib
import re
import socket
import ssl
from typing import Final

from parley.config import NetworkSettings, TlsSettings
from parley.findings import Finding

__all__ = ["ABSENT", "NOT_OURS", "examine_door"]

CONNECTS_WITHIN_S: Final = 2.0
REFUSES_WITHIN_S: Final = 0.5
"""Who does not take our certificate says so after its own was taken."""
NOT_OURS: Final = (
    "Look whether it is a router or peer of ours, of the same version and with the same tls, and whether its "
    "`users` have this name and password: without `user` here it may ask for one."
)
ABSENT: Final = "Start it there, or mend the address, or let it through the firewall."
_OWN: Final = (
    "Mend `tls`. “Several processes, several machines” says under “Who gets in” how its files are made."
)
_BOTH: Final = "Write `tls` into the settings of both, or of neither."
_REFUSED: Final = (
    "Have this machine's certificate made by their authority, or give both sides the same `authority`; then "
    "look whether it is still valid: openssl x509 -in FILE -noout -dates"
)
_DATES: Final = "Make a new one there; if it is new, set the clocks of both machines."
_NAMES: Final = (
    "Connect to a name that its certificate has, or make one there with this address in subjectAltName."
)
_AUTHORITY: Final = "Give both sides the same `authority`, and certificates that it has signed."


def examine_door(address: str, network: NetworkSettings) -> Finding:
    """Knock at one address."""
    host, _, port = address.partition("/")[2].rpartition(":")
    host = host.strip("[]")
    try:
        with socket.create_connection((host, int(port)), CONNECTS_WITHIN_S) as end:
            if network.tls is not None:
                return _shown(end, host, address, network.tls)
            if _wants_tls(end):
                return _wrong(f"{address} answers encrypted only", _BOTH)
            return Finding("network", "ok", f"{address} answers")
    except (OSError, ValueError) as error:
        return _wrong(f"{address} does not answer: {error}", ABSENT)


def _wrong(text: str, mend: str) -> Finding:
    return Finding("network", "wrong", text, mend)


def _wants_tls(end: socket.socket) -> bool:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    end.settimeout(REFUSES_WITHIN_S)
    with contextlib.suppress(OSError), context.wrap_socket(end):
        return True
    return False


def _shown(end: socket.socket, host: str, address: str, tls: TlsSettings) -> Finding:
    """Show our certificate and look at theirs, as the network does later."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    for name, file in (("authority", tls.authority), ("certificate", tls.certificate), ("key", tls.key)):
        try:
            file.read_bytes()
        except OSError as error:
            return _wrong(f"`{name}` cannot be read: {file}: {error.strerror}", _OWN)
    try:
        context.load_verify_locations(tls.authority)
    except ssl.SSLError:
        return _wrong(f"`authority` is no certificate in PEM: {tls.authority}", _OWN)
    try:
        context.load_cert_chain(tls.certificate, tls.key)
    except ssl.SSLError:
        return _wrong(f"`key` does not belong to `certificate`: {tls.key}, {tls.certificate}", _OWN)
    try:
        with context.wrap_socket(end, server_hostname=host) as shown:
            shown.settimeout(REFUSES_WITHIN_S)
            with contextlib.suppress(TimeoutError):
                shown.recv(1)
    except ssl.SSLCertVerificationError as error:
        return _wrong(f"the certificate of {address} is not taken: {error.verify_message}", _mend(error))
    except TimeoutError:
        return _wrong(f"{address} answers, but not encrypted", _BOTH)
    except ssl.SSLError as error:
        if re.search("alert|ALERT", str(error)):
            return _wrong(f"{address} does not take this machine's certificate {tls.certificate}", _REFUSED)
        return _wrong(f"{address} answers, but not encrypted", _BOTH)
    except ConnectionResetError:
        return _wrong(f"{address} does not take this machine's certificate {tls.certificate}", _REFUSED)
    return Finding("network", "ok", f"{address} answers")


def _mend(error: ssl.SSLCertVerificationError) -> str:
    what = error.verify_message
    if "expired" in what or "not yet valid" in what:
        return _DATES
    return _NAMES if "mismatch" in what else _AUTHORITY
