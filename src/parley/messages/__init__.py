"""Every message that crosses a topic: frozen types, one wire module, the table of topics."""
