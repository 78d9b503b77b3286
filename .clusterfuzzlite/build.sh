#!/bin/bash -eu
# What the image runs. script/oss_fuzz says what it reads from the environment.
exec "$SRC/fieldproof/script/oss_fuzz" build
