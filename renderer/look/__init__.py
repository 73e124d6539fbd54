"""How a picture looks beyond what a technique shows: cues of depth and contact, each a key of
`[look]`, off unless a study asks for it."""
