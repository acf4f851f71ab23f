"""The node keeps starting threads."""

import threading

import rclpy


def main():
    threading.stack_size(65536)
    stop = threading.Event()
    for count in range(1500):
        try:
            threading.Thread(target=stop.wait, daemon=True).start()
        except RuntimeError as error:
            print("ended at", count, error)
            break
    else:
        print("TRA" "CE 1500 threads", rclpy)
