#!/bin/sh
# Install python3 if it is missing, as root or with sudo. The rest of the set-up is written in Python (bootstrap.py).

if command -v apt-get > /dev/null; then
    install='apt-get update && apt-get install -y python3 python3-venv python3-dev'
elif command -v dnf > /dev/null; then
    install='dnf install -y python3 python3-devel'
elif command -v pacman > /dev/null; then
    install='pacman -Sy --needed --noconfirm python'
elif command -v zypper > /dev/null; then
    install='zypper --non-interactive install python3 python3-devel'
else
    echo 'python3 is not installed. Install Python 3.10 to 3.14 with its headers, then run make again.' >&2
    exit 3
fi

if [ "${INSTALL_SYSTEM:-}" = 0 ]; then
    sudo=none
elif [ "$(id -u)" = 0 ]; then
    sudo=
elif sudo -n true 2> /dev/null; then
    sudo='sudo -n'
elif command -v sudo > /dev/null && [ -t 0 ]; then
    echo 'python3 is not installed. To install it, sudo may ask for your password (unless INSTALL_SYSTEM=0).'
    sudo=sudo
else
    sudo=none
fi

if [ "$sudo" != none ]; then
    echo "Installing python3, which is missing: $install"
    # shellcheck disable=SC2086 # sudo may be empty, or have an option
    said=$(DEBIAN_FRONTEND=noninteractive $sudo sh -c "$install" 2>&1) && command -v python3 > /dev/null && exit 0
    echo "$said" | tail -n 4 >&2
fi
echo "python3 is not installed. Install it as root, then run make again: $install" >&2
exit 3
