"""Under which addresses this machine is reached, and the picture that phones read."""

from __future__ import annotations

import io
import ipaddress
import socket

__all__ = ["LOCAL_NAMES", "lan_addresses", "paired", "qr_svg", "qr_text"]

LOCAL_NAMES = ("localhost", "127.0.0.1", "::1")


def lan_addresses() -> tuple[str, ...]:
    """This machine's addresses in its networks, the one that leads outwards first."""
    found: list[str] = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))  # a documentation address: nothing is sent, only a way is chosen
            found.append(str(probe.getsockname()[0]))
        except OSError:
            pass
    try:
        listed = socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)
    except OSError:
        listed = []
    found += [str(item[4][0]) for item in listed]
    return tuple(dict.fromkeys(a for a in found if not ipaddress.ip_address(a).is_loopback))


def paired(address: str, code: str) -> str:
    """The address with the pairing code behind the #, so that it is sent to no server."""
    return f"{address}#code={code}" if code else address


def qr_svg(text: str) -> bytes:
    """`text` as a QR code, a complete SVG picture."""
    import segno

    out = io.BytesIO()
    segno.make(text, error="m").save(out, kind="svg", scale=6, border=4, light="#ffffff", xmldecl=False)
    return out.getvalue()


def qr_text(text: str) -> str:
    """`text` as a QR code of characters, for a terminal."""
    import segno

    out = io.StringIO()
    segno.make(text, error="l").terminal(out, compact=True)
    return out.getvalue()
