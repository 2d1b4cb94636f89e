#!/bin/sh
# Installs, uses and removes the .deb in a bare Debian, as packaging/check_deb.py starts it there.
# What it finds out are lines "RESULT name value"; it ends at once when something is wrong.
set -eu
DEB=$1
export DEBIAN_FRONTEND=noninteractive PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8
KARATE=/usr/lib/nep-studio/_internal/resources/examples/karate_greeting.nep
DESKTOP="desktop-file-utils hicolor-icon-theme libglib2.0-bin procps shared-mime-info x11-utils
xdg-utils xvfb"

tell() { echo "RESULT $1 $2"; }
install() { apt-get install --yes --quiet --no-install-recommends "$@" >/try/apt.log 2>&1 ||
    { tail -20 /try/apt.log; exit 1; }; }
purge() { apt-get purge --yes --quiet --autoremove nep-studio >/try/apt.log 2>&1; }
# xdg-open leaves the work to the desktop, as on GNOME; without one it asks programs of its own
DESKTOP_OF_ANNA="DISPLAY=:9 LC_ALL=C.UTF-8 XDG_CURRENT_DESKTOP=GNOME"
as_anna() { su anna -s /bin/sh -c "cd; export $DESKTOP_OF_ANNA; $1"; }

# All files but the notes of apt and the system's caches, and what belongs to people
all_files() {
    find / -xdev \( -path /proc -o -path /sys -o -path /dev -o -path /tmp -o -path /run \
        -o -path /home -o -path /root -o -path /try -o -path /var/cache -o -path /var/log \
        -o -path /var/lib/apt -o -path /var/lib/dpkg \) -prune -o -print | sort
}

wait_for_window() { # its title
    for _ in $(seq 300); do
        if xwininfo -display :9 -root -tree 2>/dev/null |
            grep -F -- "$1" | grep -v " 1x1+" >/try/window.txt; then
            sleep 2 # it is there, but not yet all painted
            return 0
        fi
        sleep 0.1
    done
    xwininfo -display :9 -root -tree
    echo "There is no window \"$1\"."
    exit 1
}

end_window() {
    sleep 3
    pkill --uid anna --exact nep-studio # in this namespace there is no other one
    for _ in $(seq 100); do
        if ! pgrep --uid anna --exact nep-studio >/dev/null; then
            as_anna "rm -rf .config/nep-studio" # it would ask about a start that was cut short
            return 0
        fi
        sleep 0.1
    done
    echo "The window does not end."
    exit 1
}

useradd --create-home anna
apt-get update --quiet >/try/apt.log 2>&1
tell python "$(command -v python3 || echo none)"

# 1. On a system with nothing else
all_files >/try/before
install "$DEB"
tell packages "$(grep -c '^Setting up' /try/apt.log)"
tell version "$(as_anna 'nep-studio --version')"
tell nep "$(as_anna 'nep | head -1')"
as_anna "nep-studio run $KARATE --speed 4" >/try/karate.txt
tell karate "$(grep -c 'NAO *says' /try/karate.txt)"
tell offscreen "$(as_anna "QT_QPA_PLATFORM=offscreen nep-studio picture offscreen.png" 2>/dev/null)"
tell python_after "$(command -v python3 || echo none)"
purge
all_files >/try/after
tell left "$(comm -3 /try/before /try/after | tr '\n' ' ')"

# 2. On a system with what every desktop has
install $DESKTOP
update-desktop-database
all_files >/try/before
install "$DEB"
Xvfb :9 -screen 0 1366x768x24 -fbdir /try -nolisten tcp >/try/xvfb.log 2>&1 &
while ! xwininfo -display :9 -root >/dev/null 2>&1; do sleep 0.1; done
as_anna "nep-studio picture first.png" >/dev/null 2>&1
tell xcb_begins "$(date +%s.%N)"
tell xcb "$(as_anna "nep-studio picture warm.png" 2>/dev/null)"

as_anna "gio launch /usr/share/applications/nep-studio.desktop" >/try/menu.log 2>&1 &
wait_for_window "NEP Studio"
tell menu "$(sed 's/^ *//' /try/window.txt | head -1)"
cp /try/Xvfb_screen0 /try/menu.xwd
end_window

as_anna "cp $KARATE Dance.nep"
tell type "$(as_anna 'xdg-mime query filetype Dance.nep')"
tell program "$(as_anna 'xdg-mime query default application/x-nep-studio-project')"
as_anna "xdg-open Dance.nep" >/try/open.log 2>&1 &
wait_for_window "Dance"
tell xdg_open "$(sed 's/^ *//' /try/window.txt | head -1)"
cp /try/Xvfb_screen0 /try/xdg_open.xwd
end_window
as_anna "gio open Dance.nep" >/try/open.log 2>&1 &
wait_for_window "Dance"
tell gio_open "$(sed 's/^ *//' /try/window.txt | head -1)"
end_window
purge
all_files >/try/after
tell left_on_desktop "$(comm -3 /try/before /try/after | tr '\n' ' ')"
tell all_done yes
