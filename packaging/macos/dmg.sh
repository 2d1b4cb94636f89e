#!/bin/sh
# Makes the disk image of the frozen program for macOS: packaging/macos/dmg.sh, after the freeze.
# With SIGN_AS (a "Developer ID Application" certificate in the keychain) the program is signed by
# it, else only so that Apple's processors run it. See packaging/README.md.
set -eu
cd "$(dirname "$0")/../.."
version=$(sed -n 's/^__version__ = "\(.*\)"$/\1/p' nep_studio/__init__.py)
app="dist/NEP Studio.app"
image="dist/NEP-Studio-$version-macOS-$(uname -m).dmg"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

if [ -n "${SIGN_AS:-}" ]; then
    codesign --force --deep --timestamp --sign "$SIGN_AS" "$app"
else
    codesign --force --deep --sign - "$app"
fi
codesign --verify --deep --strict "$app"

cp -R "$app" "$folder/"
ln -s /Applications "$folder/Applications"
rm -f "$image"
made=no
for _ in 1 2 3 4 5; do # the system's search may hold the volume busy for a moment
    if hdiutil create -volname "NEP Studio" -srcfolder "$folder" -fs HFS+ -format UDZO "$image"; then
        made=yes
        break
    fi
    sleep 5
done
[ "$made" = yes ]
hdiutil verify "$image"
echo "$image"
