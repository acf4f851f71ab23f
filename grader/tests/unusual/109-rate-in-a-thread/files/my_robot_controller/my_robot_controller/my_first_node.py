import threading

import rclpy


def work(node):
    rate = node.create_rate(1.0)
    counter = 0
    while rclpy.ok():
        node.get_logger().info(f"Hello {counter}")
        counter += 1
        try:
            rate.sleep()
        except Exception:
            break


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node("first_node")
    thread = threading.Thread(target=work, args=(node,), daemon=True)
    thread.start()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
        thread.join(timeout=1.0)
