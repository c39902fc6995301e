"""Who may come in: accounts, devices, passwords, passkeys, pairing codes."""
