"""Who may do what: principals, effects, risk, rules, approvals, audit. Every effect passes here."""
