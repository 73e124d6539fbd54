"""`python -m seethrough` is `seethrough`."""

import sys

from seethrough.experiment.cli import main

sys.exit(main())
