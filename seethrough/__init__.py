"""User studies of occlusion management. The rooms lie beside this folder and are imported as
`seethrough.renderer`, `seethrough.tasks`, `seethrough.experiment`, `seethrough.analysis`."""
