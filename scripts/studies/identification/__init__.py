"""How true are the numbers that passes are asked for, and how true their intervals?"""
